// Where the files lie that belong to this build: models, papers, the compiler module.
#pragma once
#include <filesystem>
#include <vector>

namespace anholon {

// The file of the program or of the shared library that this code is part of.
std::filesystem::path own_file();
// Folders in which data called `name` may lie: share/anholon/NAME of each folder above own_file(), then `in_source`.
std::vector<std::filesystem::path> data_folders(const char* name, const char* in_source);

}  // namespace anholon
