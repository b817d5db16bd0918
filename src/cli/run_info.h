// What a result file holds of a run beside its rows: enough to build the model and to make the run again.
#pragma once
#include "cli/input.h"
#include "result/run_file.h"
#include "run/simulate.h"

namespace anholon::cli {

RunInfo run_info(const Options& o, const Reader& in, const Scenario& scenario, const SimulationOptions& options);

}  // namespace anholon::cli
