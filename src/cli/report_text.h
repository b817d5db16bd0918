// How the report of a run says its numbers.
#pragma once
#include "cli/commands.h"
#include "simulation/simulate.h"

namespace anholon::cli {

// --error-estimate.
ErrorEstimate error_estimate(const Options& o);

// What a report says after "digits to trust".
std::string digits_to_trust(const ErrorReport& error);

// A residual, in as many digits as it is worth.
std::string small(double x);

}  // namespace anholon::cli
