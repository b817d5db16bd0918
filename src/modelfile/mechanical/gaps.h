// Gaps that touch zero and do not pass it.
#pragma once
#include "expr/expr.h"

namespace anholon {

// True if the form of an expression shows that it is never negative, and has no constant that keeps it from zero: an
// even power, abs, a norm, or a sum of such terms. False in doubt.
bool touches_zero_only(Expr e);

}  // namespace anholon
