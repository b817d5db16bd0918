// Texts for the numbers in the report of a run.
#pragma once
#include "simulation/simulate.h"

namespace anholon {

// The text that follows "digits to trust" in a report.
std::string digits_to_trust(const ErrorReport& error);

// A residual with its significant digits.
std::string small(double x);

}  // namespace anholon
