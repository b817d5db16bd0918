// Copies expressions into another graph. Rewriting the copy leaves the first graph, whose order of nodes is the order
// of sums, unchanged.
#pragma once
#include "expr/diff.h"

namespace anholon {

// Returns the same expressions, built in `to` by the chains of their sums (expr.h). Symbols keep their indices.
Column copied(std::span<const Expr> es, Graph& to);

}  // namespace anholon
