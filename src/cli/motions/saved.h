// Continued runs: the options that --save writes into a saved run, and their reading by --continue.
#pragma once
#include "cli/input.h"
#include "simulation/simulate.h"

namespace anholon::cli {

// Reads the saved run o.resume and sets the options that determine the motion. Throws if the command line gives them,
// too.
SavedRun continued(SimulateCommand& o);
// Throws if the saved run belongs to another model, or if a file of the model has changed.
void same_model(const SavedRun& run, const Reader& in);
// Adds the options that `continued` reads.
void describe_run(SavedRun& run, const SystemCommand& o, const Reader& in, const MotionSettings& settings);
// Throws if `end` or a time of --at is not beyond the rows of the saved run.
void beyond(const SavedRun& run, const SimulateCommand& o, const Rational& end);

}  // namespace anholon::cli
