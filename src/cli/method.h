// --method: the choice of the method by which a motion is computed, and its report.
#pragma once
#include "cli/commands.h"
#include "simulation/simulate.h"

namespace anholon::cli {

// Call it after tolerance, precision and integrator are known; throws UsageError if the requested method does not
// support the other options.
void choose_method(const Options& o, const Scenario& scenario, SimulationOptions& options);

// Prints nothing if Taylor's method made every step and no other was tried.
void print_method(const MethodReport& report);

}  // namespace anholon::cli
