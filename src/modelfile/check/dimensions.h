// Do the units of a file fit together? Every name gets a dimension, known from a unit or an unknown of Q^7, and every
// formula and element tells how they are related: what is added is alike, x' is x by a second, a position is a length,
// a mass a mass. A bare number fits any dimension, so a file without units is always consistent, and is not looked at.
#pragma once
#include "modelfile/names/names.h"

namespace anholon {

// Reports clashes, and notes the units found in the model. For a file that has no errors.
void check_dimensions(const Item& root, const Scope& scope, Model& model, Diagnostics& diagnostics);

}  // namespace anholon
