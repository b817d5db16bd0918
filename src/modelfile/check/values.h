// Checks that values are numbers.
#pragma once
#include "base/diagnostic.h"
#include "model/model.h"

namespace anholon {

// Checks that parameters and initial values are numbers, in double, node by node; a value that is not finite (it may
// only have overflowed) is computed again in numbers with unbounded exponents.
void check_values(const Model& model, Diagnostics& diagnostics);

}  // namespace anholon
