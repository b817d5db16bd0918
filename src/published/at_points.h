// Tests of expressions by their values at points. They indicate what is true, but prove nothing.
#pragma once
#include <optional>
#include <vector>

#include "tape/point.h"

namespace anholon {

// Returns the size of e at a point; for a sum, the sum of the sizes of its terms.
double size_at(Expr e, PointValues& at);
// True if e is small relative to its size at all points.
bool vanishes(Expr e, std::vector<PointValues>& points);
// True if e is more than round-off at a point.
bool is_not_zero(Expr e, PointValues& at);
// Returns the constant ratio of two expressions at all points, if it is a short fraction.
std::optional<Rational> constant_ratio(Expr a, Expr b, std::vector<PointValues>& points);
// Returns the number of nodes below e.
std::size_t number_of_nodes(Expr e);

}  // namespace anholon
