// --method: by which method a motion is computed, and what was done about it.
#pragma once
#include "cli/commands.h"
#include "simulation/simulate.h"

namespace anholon::cli {

// After tolerance, precision and integrator are known; throws UsageError where the method asked for cannot do what else
// is asked for.
void choose_method(const Options& o, const Scenario& scenario, SimulationOptions& options);

// Prints nothing if Taylor's method made every step and no other was tried.
void print_method(const MethodReport& report);

}  // namespace anholon::cli
