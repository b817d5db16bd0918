// A run and its report in JSON.
#pragma once
#include "run/simulate.h"

namespace anholon::cli {

// As `simulate --json` prints it.
std::string simulation_json(const Scenario& scenario, const MemorySink& rows, const SimulationReport& report);
// The same without columns and rows: what is kept beside them in a result file.
std::string report_json(const Scenario& scenario, const SimulationReport& report);

// A residual, in as many digits as it is worth.
std::string small(double x);

}  // namespace anholon::cli
