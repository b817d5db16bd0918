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

  const SourceText& source() const { return source_; }
  // The files that the text named when it was opened; the studio reads no others.
  const std::vector<std::string>& readable() const { return readable_; }
  // Empty if the model can be saved, else why not.
  const std::string& no_saving() const { return no_saving_; }

  enum class Saved : std::uint8_t { saved, changed_by_others, failed };
  struct Saving {
    Saved how = Saved::saved;
    std::string why;
  };
  // Writes the file that was opened, whole or not at all. A file that has changed on disk since it was read or saved is
  // overwritten only if `anyway`.
  Saving save(const std::string& text, bool anyway);

 private:
  SourceText source_;
  std::string target_, no_saving_, on_disk_;
  std::vector<std::string> readable_;
  std::mutex turn_;
};

}  // namespace anholon
