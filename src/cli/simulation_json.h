// A run and its report in JSON.
#pragma once
#include "base/json.h"
#include "cli/commands.h"
#include "simulation/simulate.h"

namespace anholon::cli {

// As `simulate --json` prints it.
std::string simulation_json(const Scenario& scenario, const MemorySink& rows, const SimulationReport& report);
// The same without columns and rows: what is kept beside them in a result file.
std::string report_json(const Scenario& scenario, const SimulationReport& report);

// --error-estimate.
ErrorEstimate error_estimate(const Options& o);

// The estimate of the error: what a report says after "digits to trust"; the entries of its object.
std::string digits_to_trust(const ErrorReport& error);
void write_error(JsonWriter& j, const ErrorReport& error);

// A residual, in as many digits as it is worth.
std::string small(double x);

}  // namespace anholon::cli
