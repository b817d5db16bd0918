// The report of a motion, in words on stderr.
#pragma once
#include <map>

#include "simulation/simulate.h"

namespace anholon::cli {

// Prints the report. units: of columns and parameters by name, as far as they are known. goes_on: the motion continues
// a saved run, and the residuals of that run count, too.
void print_report(const Scenario& scenario, const SimulationReport& report,
                  const std::map<std::string, std::string>& units, bool goes_on);

}  // namespace anholon::cli
