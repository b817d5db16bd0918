// Slip velocities that are not tangential to a contact.
#pragma once
#include "modelfile/names/names.h"

namespace anholon {

// Whether a slip velocity is a multiple of the velocity of the gap.
bool is_along_gap(Expr gap, Expr slip);

// Throws Failure, at the place of `along`, if a direction is known to have a part along the normal.
void check_tangential(const std::vector<Vector>& directions, const Vector& normal, const Model& model, Span along);

}  // namespace anholon
