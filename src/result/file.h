// Files that exist completely or not at all.
#pragma once
#include <cstdio>
#include <functional>
#include <string>
#include <string_view>

namespace anholon {

// The writer of a file holds the claim on its name, so that no two processes of this machine write to one file. The
// claim ends with its holder, even if it is killed, and leaves nothing behind.
class WritingClaim {
 public:
  WritingClaim() = default;
  // Waits up to this time for another holder. An empty path claims nothing.
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

// A file that is written sequentially as NAME.part and gets its name when it is closed. A kill leaves NAME.part and the
// previous file of that name. A path that is not a regular file (a pipe, a device) is written directly, like the
// standard output.
class GrowingFile {
 public:
  // An empty path or "-" is the standard output. Check `error` before use.
  explicit GrowingFile(const std::string& path);
  // An unfinished file stays as NAME.part.
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  std::FILE* stream() const { return file_; }
  void write(std::string_view text);
  // After this call, all text written so far is in the file, whatever happens to the program.
  void flush();
  // Returns an empty string, or the reason of a failure; the text written then stays in NAME.part.
  std::string close();
  // Removes the unfinished file.
  void remove();
  const std::string& error() const { return error_; }
  // The path of the unfinished file; empty if there is none.
  std::string part() const { return closed_ ? std::string() : beside_; }

 private:
  void fail(int why);
  std::string shown_, target_, beside_, error_;
  bool begun_ = false, closed_ = false;
  std::size_t unwritten_ = 0;  // bytes since the disk was last asked for
  WritingClaim claim_;
  std::FILE* file_ = nullptr;
};

// Asks the system to write to the disk what a file has in memory, and does not wait: the sync at the end then has less
// to wait for.
void start_writing(const std::string& path);

// The target of a link, which may be missing; other names are returned unchanged.
std::string target_of_link(const std::string& path);

// Writes beside the file and renames: a kill leaves the old file or the new one. Returns an empty string, or the reason
// of a failure.
std::string write_whole(const std::string& path, const std::string& text);
// Like write_whole(path, text), by a function that returns false at its first failure.
std::string write_whole(const std::string& path, const std::function<bool(std::FILE*)>& write);
// Like write_whole(); an empty path or "-" is the standard output.
std::string write_stream(const std::string& path, const std::function<bool(std::FILE*)>& write);
// Like write_whole(), by a function that gets the name to write to and returns the reason of a failure.
std::string write_whole_by_name(const std::string& path,
                                const std::function<std::string(const std::string& beside)>& write);

// Returns an empty string, or the reason why no file can be written there. An existing file is not changed. Call it
// before a long computation.
std::string obstacle_to_writing(const std::string& path);

}  // namespace anholon
