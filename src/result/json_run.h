// The JSON of a run: the report with columns and rows. (doc/json.md)
#pragma once
#include <string>
#include <string_view>

#include "result/run_file.h"

namespace anholon {

// Throws Failure.
RunFile read_json_run(std::string_view text);
// The text of a file.
std::string json_run(const RunFile& run);

}  // namespace anholon
