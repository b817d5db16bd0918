// The general statement behind an identity: an identity often holds because a long subexpression cancels, whatever its
// value.
#pragma once
#include "expr/expr.h"

namespace anholon {

// True if e vanishes at a random point up to round-off.
bool seems_zero(Expr e);

// Returns e with subexpressions replaced by new symbols, the longest first, as long as the result still seems to vanish
// at a random point; the result is therefore a guess. If it is zero for all values of its symbols, e is zero as well.
// The new symbols are quasi-velocities numbered from `first`.
Expr generalized(Expr e, std::uint32_t first = 1000);

}  // namespace anholon
