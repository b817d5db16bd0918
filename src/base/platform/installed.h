// Locations of the files that belong to this build: models, papers, the compiler module.
#pragma once
#include <filesystem>
#include <vector>

namespace anholon {

// Returns the path of the program or of the shared library that holds this code.
std::filesystem::path own_file();
// Returns folders that may hold data called `name`: share/anholon/NAME of each folder above own_file(), then
// `in_source`.
std::vector<std::filesystem::path> data_folders(const char* name, const char* in_source);

}  // namespace anholon
