// Checks that orientations are rotations. Matrices and quaternions are rotations only if their numbers, or constraints,
// make them so.
#pragma once
#include "base/outcome.h"
#include "model/model.h"
#include "tape/point.h"

namespace anholon {

// True if a body has an orientation that is not built of turns alone.
bool may_be_no_rotation(const Model& model);

// Fails if the axes of an orientation are not of length 1, at right angles and right-handed at a point, up to the
// rounding of numbers in a file.
Outcome oriented(const Model& model, PointValues& at);

}  // namespace anholon
