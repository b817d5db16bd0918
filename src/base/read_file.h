// The bytes of a file.
#pragma once
#include <filesystem>
#include <string>

namespace anholon {

// False, and why, if it cannot be read.
bool read_file(const std::filesystem::path& path, std::string& text, std::string* why = nullptr);

}  // namespace anholon
