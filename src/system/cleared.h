// Constraints without poles. For example, y' = x' tan(u) has a pole where cos(u) = 0. A motion passes this pole with x'
// = 0 and a finite y', but near it the equation and its derivatives lose digits; x' sin(u) = y' cos(u) loses none.
#pragma once
#include "expr/diff.h"

namespace anholon {

// Returns a sum of products of sums, multiplied by its divisors; a tangent is a sine divided by a cosine. The result is
// zero where the sum is zero, and has a value also where the sum has a pole. Divisors that contain derivatives stay:
// without them there would be states, such as rest, that the sum excludes.
Expr cleared(Expr e);

}  // namespace anholon
