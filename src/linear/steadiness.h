// Decides whether a linear model is one of a steady motion.
#pragma once
#include "linear/linear_point.h"

namespace anholon {

// Sets the kind of the motion through the point, the coordinates that have no influence (cyclic) and the others (core).
// A state whose rate is no more than the error of a number rounded to sixteen digits counts as resting; a note says so.
// `check`: true if the motion is also examined at another point; else the motion is `unchecked`.
void look_for_steadiness(const LinearPoint& point, bool check, LinearModel& out);

}  // namespace anholon
