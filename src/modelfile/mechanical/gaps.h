// Gaps that touch zero and do not pass it.
#pragma once
#include "expr/expr.h"

namespace anholon {

// Whether the form of an expression shows that it is never negative, and has no constant that keeps it from zero: an even power, abs, a
// norm, or a sum of such terms. What is in doubt is no such expression.
bool touches_zero_only(Expr e);

}  // namespace anholon
