// A file that is there as a whole or not at all.
#pragma once
#include <cstdio>
#include <functional>
#include <string>

namespace anholon {

// Writes beside the file and renames: a kill leaves the old file or the new one. Empty, or why it could not be written.
std::string write_whole(const std::string& path, const std::string& text);
// The same by a function that returns false at its first failure.
std::string write_whole(const std::string& path, const std::function<bool(std::FILE*)>& write);

// Before what takes long is computed: empty, or why no file could be written there. What is there stays as it is.
std::string obstacle_to_writing(const std::string& path);

}  // namespace anholon
