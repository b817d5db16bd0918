// Texts for the numbers in the report of a run.
#pragma once
#include "simulation/simulate.h"

namespace anholon {

// The text that follows "digits to trust" in a report.
std::string digits_to_trust(const ErrorReport& error);
// Names the multipliers to which these digits do not belong: ", not for lambda.a, …"; empty if there are none.
std::string not_vouched_for(const ErrorReport& error);

// A residual with its significant digits.
std::string small(double x);

}  // namespace anholon
