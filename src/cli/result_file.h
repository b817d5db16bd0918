// Result files as arguments of commands.
#pragma once
#include "cli/input.h"
#include "result/hdf5.h"

namespace anholon::cli {

// Throws UsageError with the position of the error.
RunFile read_result(const std::string& path);

}  // namespace anholon::cli
