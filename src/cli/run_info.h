// What a result file holds of a run beside its rows: enough to build the model and to make the run again.
#pragma once
#include "cli/input.h"
#include "result/run_file.h"
#include "simulation/simulate.h"

namespace anholon::cli {

RunInfo run_info(const Options& o, const Reader& in, const Scenario& scenario, const SimulationOptions& options);
// The way back: the options with what was asked for when the run was made, so far as its start and its equations depend
// on it.
Options options_of(const RunInfo& run, Options o);

}  // namespace anholon::cli
