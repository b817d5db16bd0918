// Proofs of zero by cases: the sign of each expression that decides (in sign, abs, piecewise) is positive, negative or
// zero.
#pragma once
#include <functional>

#include "expr/expr.h"

namespace anholon {

// True if `zero` holds of e in each case, with the branches of the case substituted. If an expression that decides is
// zero, a symbol in which it is linear gets the value that makes it zero. Returns false if there are too many cases.
bool shown_zero_by_signs(Expr e, const std::function<bool(Expr)>& zero);

}  // namespace anholon
