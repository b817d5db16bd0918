// Runs that go on: what --save writes beside the state, and how --continue takes it up.
#pragma once
#include "cli/input.h"
#include "simulation/simulate.h"

namespace anholon::cli {

// The options that decide the motion, taken from a saved run; throws where the command line gives them, too.
SavedRun continued(Options& o);
// Throws if the saved run is of another model.
void same_model(const SavedRun& run, const Reader& in);
// Adds what `continued` needs.
void describe_run(SavedRun& run, const Options& o, const Reader& in, const Formulation& form,
                  const SimulationOptions& options);
// Throws if the rows asked for are not all beyond those of the saved run.
void beyond(const SavedRun& run, const Options& o, const Rational& end);

}  // namespace anholon::cli
