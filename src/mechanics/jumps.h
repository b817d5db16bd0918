// Where an expression jumps: a sign, a choice between two formulas, a table that holds its values, an angle atan2 at its
// branch cut.
//
// Let s be what decides, with the expression f+ for s > 0 and f- for s < 0. f is continuous where s changes its sign if
// f+ - f- is zero; or a multiple of s: (f+ - f-)/s, in lowest terms, has no denominator that f+ - f- does not have; or
// zero where s = 0, with the coordinate put in that makes it so. Choices that are left there are made by the parameters.
#pragma once
#include <vector>

#include "expr/expr.h"

namespace anholon {

// Whether e may jump along a motion with these parameters; false if it is proved continuous wherever all its parts have
// values.
bool may_jump(Expr e, const std::vector<double>& parameters);

}  // namespace anholon
