// Homogeneous functions, told by how an expression is built: no polynomials are multiplied out.
#pragma once
#include <functional>
#include <optional>

#include "expr/expr.h"

namespace anholon {

// The degree k of e in the symbols x for which `in` holds, so that sum x de/dx = k e by Euler's theorem. Nothing where
// the structure does not show it: another writing of e may.
std::optional<Rational> homogeneous_degree(Expr e, const std::function<bool(const Node&)>& in);

}  // namespace anholon
