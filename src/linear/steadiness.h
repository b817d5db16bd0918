// Whether a linear model is one of a steady motion.
#pragma once
#include "linear/linear_point.h"

namespace anholon {

// Sets the kind of the motion through the point, the coordinates that have no influence (cyclic) and the others (core).
// A state whose rate is that of a number rounded to sixteen digits counts as one that rests; a note says so. `check`:
// whether the motion is looked at elsewhere, too; else it is `unchecked`.
void look_for_steadiness(const LinearPoint& point, bool check, LinearModel& out);

}  // namespace anholon
