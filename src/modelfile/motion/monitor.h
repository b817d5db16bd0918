// [monitor] name = "formula": numbers to be watched along the motion, over everything that formulas know and the
// multipliers.
#pragma once
#include "modelfile/names/names.h"

namespace anholon {

void read_monitors(const Item& section, Scope& scope, Model& model, Diagnostics& diagnostics);

}  // namespace anholon
