// Values of expressions as balls, and verified points on the manifold of the constraints.
#pragma once
#include <unordered_map>

#include "expr/diff.h"
#include "numeric/enclosure.h"

namespace anholon {

using BallPoint = std::unordered_map<NodeId, Ball>;  // symbol -> value

// Returns the values of expressions as balls; a value that is not defined on all of the balls is not finite. `at` holds
// every symbol of the expressions.
std::vector<Ball> enclose(std::span<const Expr> es, const BallPoint& at);

// Returns the expressions with each branching function whose condition the balls decide replaced by the branch that
// holds at the point. The results have the same values there.
Column on_branches(std::span<const Expr> es, const BallPoint& at);

}  // namespace anholon
