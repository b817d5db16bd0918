// Formulas of a run's model, computed at the rows of the run.
#pragma once
#include <string>

#include "cli/input.h"
#include "result/run_file.h"

namespace anholon::cli {

// Adds a column for each name that is a formula of the run's model, such as disc.center.z or norm(vel(P.center)), and
// is no column yet. Names that are no formulas are ignored, for the later look-up of columns. Throws UsageError if a
// formula is not a number, or needs numbers that the run does not hold.
void add_formulas(RunFile& run, std::vector<std::string> names);

// Reads the model of a run, with the options with which it was computed.
Reader model_of(const RunFile& run, const ModelCommand& was);

}  // namespace anholon::cli
