// Expressions in a graph of their own: whoever rewrites there leaves the first graph, whose order of nodes is the order
// of sums, as it was.
#pragma once
#include "expr/diff.h"

namespace anholon {

// The same expressions, built in `to` from the short way of their sums. Symbols keep their indices.
Column copied(std::span<const Expr> es, Graph& to);

}  // namespace anholon
