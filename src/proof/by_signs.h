// Zero by cases: the sign of each expression that decides (sign, abs, piecewise) is positive, negative or zero.
#pragma once
#include <functional>

#include "expr/expr.h"

namespace anholon {

// Whether `zero` holds of e in each case, with the branches of the case put in. Where an expression that decides is zero, a
// symbol in which it is linear takes the value that makes it so. false also where there are too many cases.
bool shown_zero_by_signs(Expr e, const std::function<bool(Expr)>& zero);

}  // namespace anholon
