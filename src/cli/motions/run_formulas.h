// Formulas of a run's model, computed at the rows of the run.
#pragma once
#include <string>

#include "cli/input.h"
#include "result/run_file.h"

namespace anholon::cli {

// Adds a column for each of the names that the run does not hold and that is a formula of its model, such as
// disc.center.z or norm(vel(P.center)). Other names are left to the later look-up of columns; throws if a formula has no
// value here.
void add_formulas(RunFile& run, std::vector<std::string> names);

// The model of a run, with the options of its computation.
Reader model_of(const RunFile& run, const ModelCommand& was);

}  // namespace anholon::cli
