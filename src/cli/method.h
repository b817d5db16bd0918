// --method: the choice of the method by which a motion is computed, and its report.
#pragma once
#include "cli/commands.h"
#include "simulation/simulate.h"

namespace anholon::cli {

// Call it after tolerance, precision and integrator are known; throws UsageError if the requested method does not
// support the other options.
void choose_method(const Options& o, const Scenario& scenario, SimulationOptions& options);

// What the options ask of a method.
MethodDemands demands(const Options& o, const SimulationOptions& options);
// The option that makes such a demand.
std::string option_of(MethodRefusal::Of of, const Options& o);
// Says that the tolerance is raised to the least one of the method, if it is.
void say_raised(const MethodInfo& method, const SimulationOptions& options);

// Prints nothing if Taylor's method made every step and no other was tried.
void print_method(const MethodReport& report);

}  // namespace anholon::cli
