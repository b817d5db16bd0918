// Whether what has to be a number is one.
#pragma once
#include "base/diagnostic.h"
#include "model/model.h"

namespace anholon {

// Parameters and initial values are numbers. Asked in double, node by node; where that finds none (it may only have
// overflowed), in numbers without such bounds.
void check_values(const Model& model, Diagnostics& diagnostics);

}  // namespace anholon
