// The parts of a result file besides its rows: they suffice to build the model and to repeat the run.
#pragma once
#include "cli/input.h"
#include "result/run_file.h"
#include "simulation/simulate.h"

namespace anholon::cli {

// settings: all settings of the run. continued: the saved run that this run continues, or empty.
RunInfo run_info(const SystemCommand& o, const Reader& in, const Scenario& scenario, const MotionSettings& settings,
                 const std::string& continued = {});
// Returns the options with those settings of the run on which its start and its equations depend.
SystemCommand options_of(const RunInfo& run, SystemCommand o);

}  // namespace anholon::cli
