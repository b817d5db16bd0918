// Roots of formulas that are exactly zero on one side of a branch.
#pragma once
#include "expr/expr.h"

namespace anholon {

// Returns base^e for a number e. A formula such as (max(0, x))^(3/2), sqrt(-min(0, x)) or ((abs(x) - x)/2)^(3/2) has a
// part by which it is 0 on one side. There the result has neither the round-off of a sum nor the slope of a root at 0:
// it is 0 on that side, and the power of the other value on the other side. The exponent is a copy, because numbers of
// the graph move when it grows.
Expr power_by_sides(Expr base, Rational e);

}  // namespace anholon
