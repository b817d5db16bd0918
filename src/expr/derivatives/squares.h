// Sums of squares, such as the square of a speed, whose roots have a kink where all squares vanish.
#pragma once
#include "expr/expr.h"

namespace anholon {

// True if the structure shows that u is a sum of products of squares that may vanish, and that u is at most of second
// order near its zeros: |u(x + d)| <= C |d|^2 where u(x) = 0. The root of such a u is at most of first order there.
bool is_sum_of_squares(const Graph& graph, NodeId u);

// True if a power of the node u with an exponent that is not whole occurs in e.
bool holds_root_of(Expr e, NodeId u);

}  // namespace anholon
