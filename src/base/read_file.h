// Reads the bytes of a file.
#pragma once
#include <filesystem>
#include <string>

namespace anholon {

// Reads the file into `text`. Returns false if the file cannot be read, and stores the reason in `why`.
bool read_file(const std::filesystem::path& path, std::string& text, std::string* why = nullptr);

}  // namespace anholon
