// The partial derivatives of one node of the graph.
#pragma once
#include <vector>

#include "expr/expr.h"

namespace anholon {

// Computes the partial derivatives of a node with respect to its summands, in their order.
void local_partials(Graph& g, NodeId id, std::vector<Expr>& out);

}  // namespace anholon
