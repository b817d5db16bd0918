// Continued runs: the data that --save writes beside the state, and how --continue reads them.
#pragma once
#include "cli/input.h"
#include "simulation/simulate.h"

namespace anholon::cli {

// The options that determine the motion, taken from a saved run; throws if the command line gives them as well.
SavedRun continued(SimulateCommand& o);
// Throws if the saved run belongs to another model.
void same_model(const SavedRun& run, const Reader& in);
// Adds the data that `continued` needs.
void describe_run(SavedRun& run, const SystemCommand& o, const Reader& in, const MotionSettings& settings);
// Throws if not all requested rows are beyond those of the saved run.
void beyond(const SavedRun& run, const SimulateCommand& o, const Rational& end);

}  // namespace anholon::cli
