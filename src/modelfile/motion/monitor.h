// [monitor] name = "formula": numbers that are watched along the motion; the formulas may use all names of formulas and
// the multipliers.
#pragma once
#include "modelfile/names/names.h"

namespace anholon {

void read_monitors(const Item& section, Scope& scope, Model& model, Diagnostics& diagnostics);

}  // namespace anholon
