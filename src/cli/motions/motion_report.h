// The report of a motion, in words on stderr.
#pragma once
#include "simulation/simulate.h"

namespace anholon::cli {

void print_report(const Scenario& scenario, const SimulationReport& report);

}  // namespace anholon::cli
