// Roots of formulas that are exactly zero on one side of a branch.
#pragma once
#include "expr/expr.h"

namespace anholon {

// base^e for a number e. The part of a formula by which it is 0 on one side, as in (max(0, x))^(3/2), sqrt(-min(0, x)) or
// ((abs(x) - x)/2)^(3/2), has on that side neither the round-off of a sum nor the slope of a root at 0: the power is
// 0 there, and on the other side that of the other value. The exponent is a copy, as numbers of the graph move when it grows.
Expr power_by_sides(Expr base, Rational e);

}  // namespace anholon
