// Files that are there as a whole or not at all.
#pragma once
#include <cstdio>
#include <functional>
#include <string>

namespace anholon {

// Whoever writes a file holds the claim on its name, so that no two processes of this machine write to one. It ends
// with its holder, killed or not, and leaves nothing behind.
class WritingClaim {
 public:
  WritingClaim() = default;
  // Waits so long for another holder. An empty path claims nothing.
  explicit WritingClaim(const std::string& path, double seconds = 0);
  ~WritingClaim();
  WritingClaim(const WritingClaim&) = delete;
  WritingClaim& operator=(const WritingClaim&) = delete;
  // Empty, or "cannot write PATH: another process writes it".
  const std::string& error() const { return error_; }

 private:
  int socket_ = -1;
  std::string error_;
};

// A file that is written from its first byte to its last: as NAME.part, which takes the name when it is closed. A kill
// leaves NAME.part, and under the name what was there before. What is no regular file (a pipe, a device) is written to
// as it is, like the standard output.
class GrowingFile {
 public:
  // An empty path or "-" is the standard output. Check `error` before use.
  explicit GrowingFile(const std::string& path);
  // What was begun and not closed stays NAME.part.
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  std::FILE* stream() const { return file_; }
  void write(const std::string& text);
  // What was written so far is in the file, whatever happens to the program.
  void flush();
  // Empty, or why it could not be written; then what there is stays NAME.part.
  std::string close();
  // Takes back what was begun.
  void remove();
  const std::string& error() const { return error_; }
  // Where what was written lies while it has no name; empty where there is no such file.
  std::string part() const { return closed_ ? std::string() : beside_; }

 private:
  void fail(int why);
  std::string shown_, target_, beside_, error_;
  bool begun_ = false, closed_ = false;
  WritingClaim claim_;
  std::FILE* file_ = nullptr;
};

// Where a link leads; other names stay.
std::string target_of_link(const std::string& path);

// Writes beside the file and renames: a kill leaves the old file or the new one. Empty, or why it could not be written.
std::string write_whole(const std::string& path, const std::string& text);
// The same by a function that returns false at its first failure.
std::string write_whole(const std::string& path, const std::function<bool(std::FILE*)>& write);
// The same by a function that is given the name to write to, and returns why it could not.
std::string write_whole_by_name(const std::string& path,
                                const std::function<std::string(const std::string& beside)>& write);

// Before what takes long is computed: empty, or why no file could be written there. What is there stays as it is.
std::string obstacle_to_writing(const std::string& path);

}  // namespace anholon
