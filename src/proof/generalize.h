// The general statement behind an identity: what makes it true is often that a long subexpression cancels, whatever it
// is.
#pragma once
#include "expr/expr.h"

namespace anholon {

// Whether e vanishes at a random point, as far as its round-off tells.
bool seems_zero(Expr e);

// e with subexpressions replaced by fresh symbols, the longest first, as long as the result still seems to vanish:
// judged by numbers at a random point, so what comes back is a guess. If it is zero for all values of its symbols, so
// is e. The fresh symbols are quasi-velocities with numbers from `first` on.
Expr generalized(Expr e, std::uint32_t first = 1000);

}  // namespace anholon
