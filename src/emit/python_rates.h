// The rates in independent velocities as a part of a Python module: a straight line of statements, one operation each,
// which NumPy runs in blocks of states. The module has DEFAULTS and _One.
#pragma once
#include <string>

#include "emit/rate_formulas.h"

namespace anholon::emit {

// Returns the text. REQUIRES: the rates are explicit, and no symbol is an input.
std::string python_rates(const RateFormulas& formulas);

}  // namespace anholon::emit
