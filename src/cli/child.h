// Other programs that a command needs: found, run without a shell, never outliving it.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace anholon::cli {

struct Child {
  enum class End { exited, not_started, out_of_time, stopped, too_much };
  End end = End::exited;
  int status = 0;        // exit status; 128 + the signal that ended it; errno where it could not be started
  std::string out, err;  // what it printed; of `err` the last part
  bool ok() const { return end == End::exited && status == 0; }
};

// Runs arguments[0] with its arguments, its input empty, in a process group of its own, which is gone when this
// returns. `stop`: asked ten times a second. `most_output`: bytes of `out` after which it is ended.
Child run_child(const std::vector<std::string>& arguments, double seconds, const std::function<bool()>& stop,
                std::size_t most_output);

// The first of these names that is a program on the PATH, or one named by its path; empty if none is.
std::string find_program(const std::vector<std::string>& names);

// A folder of this process alone, gone with the object.
class TemporaryFolder {
 public:
  TemporaryFolder();  // throws UsageError where none can be made
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace anholon::cli
