// The model that the studio has opened: its text, the files to which it may refer, and where it is saved.
#pragma once
#include <mutex>
#include <string>
#include <vector>

#include "base/diagnostic.h"

namespace anholon {

// The files to which a text refers, under the names in the text: `base`, and `file` of tables, with their places.
// Throws Failure on a syntax error of TOML.
struct NamedFile {
  std::string name;
  Span span;
};
std::vector<NamedFile> files_named(const SourceText& source);

class OpenedFile {
 public:
  // `shipped`: a model that comes with the program, to which the studio does not write.
  OpenedFile(SourceText source, bool shipped);

  // The text as it was opened; text() returns the file as it is now.
  const SourceText& source() const { return source_; }
  // The files that the text named when it was opened; the studio reads no others.
  const std::vector<std::string>& readable() const { return readable_; }
  // Empty if the model can be saved, otherwise the reason why not.
  const std::string& no_saving() const { return no_saving_; }

  // A text of the file, and its hash; with a save, a page sends the hash of the text that it knows.
  struct Text {
    std::string text, hash;
  };
  // The file as it is now; if it cannot be read any more, the last text that was read or saved.
  Text text();

  enum class Saved : std::uint8_t { saved, changed_by_others, failed };
  struct Saving {
    Saved how = Saved::saved;
    std::string why, hash;  // the hash of the saved text
  };
  // Writes the file that was opened, completely or not at all. A file that differs from the text with the hash `known`
  // is overwritten only if `anyway`, or if it contains `text` already.
  Saving save(const std::string& text, const std::string& known, bool anyway);

 private:
  bool read(std::string& text) const;

  SourceText source_;
  std::string target_, no_saving_, last_;
  std::vector<std::string> readable_;
  std::mutex turn_;
};

}  // namespace anholon
