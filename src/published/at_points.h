// Tests of expressions by their values at points; they show what is true, and prove nothing.
#pragma once
#include <optional>
#include <vector>

#include "tape/point.h"

namespace anholon {

// Size at a point; for a sum, the sum of the sizes of its terms.
double size_at(Expr e, PointValues& at);
// Whether e is small relative to its size at all points.
bool vanishes(Expr e, std::vector<PointValues>& points);
// Whether e is more than round-off at a point.
bool is_not_zero(Expr e, PointValues& at);
// The constant ratio of two expressions at all points, if it is a short fraction.
std::optional<Rational> constant_ratio(Expr a, Expr b, std::vector<PointValues>& points);
// The number of nodes below e.
std::size_t number_of_nodes(Expr e);

}  // namespace anholon
