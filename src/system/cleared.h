// Constraints without poles. y' = x' tan(u) has one where cos(u) = 0, which a motion passes: there x' = 0, and y' is
// finite. Near it the equation and its derivatives lose digits; x' sin(u) = y' cos(u) loses none.
#pragma once
#include "expr/diff.h"

namespace anholon {

// A sum of products of sums, times what they are divided by; a tangent is a sine divided by a cosine. It is zero where the sum
// is, and has a value also where the sum has a pole. Divisors that contain derivatives stay: without them there would be
// states, such as rest, that the sum excludes.
Expr cleared(Expr e);

}  // namespace anholon
