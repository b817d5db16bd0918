// Formulas of its model, computed at the rows of a run.
#pragma once
#include <string>

#include "cli/input.h"
#include "result/run_file.h"

namespace anholon::cli {

// Adds a column for each of the options' columns (and their abscissa) that the run does not hold and that is a formula
// of its model, as disc.center.z or norm(vel(P.center)). What is none is left to whoever looks for the columns; throws
// what is a formula and has no value here.
void add_formulas(RunFile& run, const Options& o);

// The model of a run with what was asked for when it was made.
Reader model_of(const RunFile& run, const Options& was);

}  // namespace anholon::cli
