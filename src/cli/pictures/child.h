// Runs other programs that a command needs, without a shell; none outlives the command.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace anholon::cli {

struct Child {
  enum class End { exited, not_started, out_of_time, stopped, too_much };
  End end = End::exited;
  int status = 0;        // exit status; 128 + the signal that ended it; errno if it could not be started
  std::string out, err;  // the output of the child; of `err` only the last part
  bool ok() const { return end == End::exited && status == 0; }
};

// Runs the program arguments[0] with an empty input in a process group of its own; all processes of the group have
// ended when the function returns. The child is ended after `seconds`, if `stop` returns true, which is called several
// times a second, or if `out` has more than `most_output` bytes.
Child run_child(const std::vector<std::string>& arguments, double seconds, const std::function<bool()>& stop,
                std::size_t most_output);

// Returns the first of these names that is a program on the PATH or a path of a program; empty if none is.
std::string find_program(const std::vector<std::string>& names);

// A folder for this process alone, removed with the object.
class TemporaryFolder {
 public:
  TemporaryFolder();  // throws UsageError if none can be created
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace anholon::cli
