// Finds gravity that acts twice: by [gravity] and by a potential.
#pragma once
#include "model/model.h"

namespace anholon {

// Adds a note for each potential whose value is that of gravity in a uniform field on a body or on all bodies,
//   V = -m f.r + const,  f the field, r the mass centre,
// or whose part with a parameter of the field (such as the part of m*g*y + k*x^2/2 with g) has this value. The
// functions are compared by their values at generic points.
void note_doubled_gravity(Model& model);

}  // namespace anholon
