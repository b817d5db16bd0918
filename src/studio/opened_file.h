// The model that the studio has opened: its text, the files that it may refer to, and where it is saved.
#pragma once
#include <mutex>
#include <string>
#include <vector>

#include "base/diagnostic.h"

namespace anholon {

// The files that a text refers to, as it writes them: `base`, and `file` of tables, with their places. Throws Failure
// on a syntax error of TOML.
struct NamedFile {
  std::string name;
  Span span;
};
std::vector<NamedFile> files_named(const SourceText& source);

class OpenedFile {
 public:
  // `shipped`: a model that comes with the program, which is not written to.
  OpenedFile(SourceText source, bool shipped);

  // As it was opened; `text` gives the file as it is now.
  const SourceText& source() const { return source_; }
  // The files that the text named when it was opened; the studio reads no others.
  const std::vector<std::string>& readable() const { return readable_; }
  // Empty if the model can be saved, else why not.
  const std::string& no_saving() const { return no_saving_; }

  // A text of the file, and its hash, by which a page tells at a save which text it knows.
  struct Text {
    std::string text, hash;
  };
  // The file as it is now; if it cannot be read any more, its last text that was read or saved.
  Text text();

  enum class Saved : std::uint8_t { saved, changed_by_others, failed };
  struct Saving {
    Saved how = Saved::saved;
    std::string why, hash;  // the hash of the text that is saved
  };
  // Writes the file that was opened, whole or not at all. A file that differs from the text whose hash is `known` is
  // overwritten only if `anyway`, or if it holds `text` already.
  Saving save(const std::string& text, const std::string& known, bool anyway);

 private:
  bool read(std::string& text) const;

  SourceText source_;
  std::string target_, no_saving_, last_;
  std::vector<std::string> readable_;
  std::mutex turn_;
};

}  // namespace anholon
