// The parts of a result file beside its rows: enough to build the model and to repeat the run.
#pragma once
#include "cli/input.h"
#include "result/run_file.h"
#include "simulation/simulate.h"

namespace anholon::cli {

// The settings are those of the run, complete; continued: the saved run from which it goes on, if there is one.
RunInfo run_info(const SystemCommand& o, const Reader& in, const Scenario& scenario, const MotionSettings& settings,
                 const std::string& continued = {});
// The inverse: the options, with those settings of the run on which its start and its equations depend.
SystemCommand options_of(const RunInfo& run, SystemCommand o);

}  // namespace anholon::cli
