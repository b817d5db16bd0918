// A file that is there as a whole or not at all.
#pragma once
#include <string>

namespace anholon {

// Writes beside the file and renames: a kill leaves the old file or the new one. Empty, or why it could not be written.
std::string write_whole(const std::string& path, const std::string& text);

}  // namespace anholon
