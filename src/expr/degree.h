// Homogeneous functions, recognized by the structure of an expression: polynomials are not multiplied out.
#pragma once
#include <functional>
#include <optional>

#include "expr/expr.h"

namespace anholon {

// Returns the degree k of e in the symbols x for which `in` holds, so that sum x de/dx = k e by Euler's theorem.
// Returns nullopt if the structure does not show the degree; another form of e may show it.
std::optional<Rational> homogeneous_degree(Expr e, const std::function<bool(const Node&)>& in);

}  // namespace anholon
