// Result files as arguments of commands.
#pragma once
#include "cli/input.h"
#include "result/format.h"

namespace anholon::cli {

// Reads a run. Throws UsageError with the position of the error.
RunFile read_result(const std::string& path);

// Throws UsageError if the name has an ending of no format in `formats`. A name without an ending passes, and so do
// pipes and devices.
void check_ending(const std::string& output, const std::vector<const ResultFormat*>& formats);

// Throws UsageError if this build cannot write the format; null passes.
void check_format(const ResultFormat* format);

}  // namespace anholon::cli
