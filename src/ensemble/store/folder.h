// Files of a folder that many processes fill, on one machine or on several with a common file system.
//
// A file is written under a name of its own, synchronized, and given its final name by a hard link: the name is taken
// once, by one process, and from then on the file is complete. A kill leaves a file whose name begins with ".tmp-".
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace anholon {

struct Committed {
  enum class How : std::uint8_t { mine, other, failed } how = How::failed;
  std::string error;  // the reason of a failure
};

// Writes a file that exists completely or not at all. `other`: a file of that name existed before, and is not changed.
Committed commit_file(const std::string& folder, const std::string& name, std::string_view bytes);

// The names of all files in a folder, in ascending order. Throws Failure without a place if the folder cannot be read.
std::vector<std::string> files_of(const std::string& folder);

// Removes unfinished files of processes of this machine that have ended. Returns the number of unfinished files that
// are left.
std::size_t clear_unfinished(const std::string& folder);

}  // namespace anholon
