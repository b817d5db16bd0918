#include "modelfile/mechanical/tangential.h"

#include <cmath>

#include "expr/normal.h"
#include "modelfile/names/constant.h"

namespace anholon {

bool is_along_gap(Expr gap, Expr slip) {
  const Expr rate = total_derivative(gap);
  Column velocities;
  for (const NodeId id : symbols(std::vector<Expr>{rate, slip}))
    if (const Node& n = slip.graph->node(id); n.kind == Kind::jet && n.order == 1)
      velocities.push_back(slip.graph->jet(n.index, 1));
  const Column n = gradient(rate, velocities), t = gradient(slip, velocities);
  for (std::size_t i = 0; i < n.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!proved_zero(n[i] * t[j] - n[j] * t[i])) return false;
  return !n.empty();
}

void check_tangential(const std::vector<Vector>& directions, const Vector& normal, const Model& model, Span along) {
  constexpr double kRoundOff = 1e-9;
  for (const Vector& d : directions)
    if (const auto part = constant_value(model, dot(d, normal)); part && std::abs(*part) > kRoundOff)
      throw Failure(along, "a direction of the slip has a part along the normal, which is no slip",
                    "leave out 'along': two tangential directions are chosen");
}

}  // namespace anholon
