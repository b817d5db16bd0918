// The parts of a result file beside its rows: enough to build the model and to repeat the run.
#pragma once
#include "cli/input.h"
#include "result/run_file.h"
#include "simulation/simulate.h"

namespace anholon::cli {

// The settings are those of the run, complete.
RunInfo run_info(const Options& o, const Reader& in, const Scenario& scenario, const MotionSettings& settings);
// The inverse: the options, with those settings of the run on which its start and its equations depend.
Options options_of(const RunInfo& run, Options o);

}  // namespace anholon::cli
