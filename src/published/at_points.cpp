#include "published/at_points.h"

#include <algorithm>
#include <cmath>

namespace anholon {

static constexpr double kVanishes = 1e-8;  // relative to the size of the terms

double size_at(Expr e, PointValues& at) {
  const Graph& g = *e.graph;
  if (g.node(e.id).kind == Kind::product) {
    double size = 1;
    for (const Term& t : g.terms(e.id)) {
      const double power = g.rational(t.weight).get_d();
      const bool of_sum = g.node(t.node).kind == Kind::sum && power > 0;
      size *= std::abs(std::pow(of_sum ? size_at({e.graph, t.node}, at) : at({e.graph, t.node}), power));
    }
    return size;
  }
  if (g.node(e.id).kind != Kind::sum) return std::abs(at(e));
  double size = 0;
  for (const Term& t : g.summands(e.id)) size += std::abs(g.rational(t.weight).get_d() * at({e.graph, t.node}));
  return size;
}

bool vanishes(Expr e, std::vector<PointValues>& points) {
  return std::all_of(points.begin(), points.end(),
                     [&](PointValues& at) { return std::abs(at(e)) <= kVanishes * (1e-6 + size_at(e, at)); });
}

bool is_not_zero(Expr e, PointValues& at) { return std::abs(at(e)) > 1e-9 * (1e-6 + size_at(e, at)); }

std::optional<Rational> constant_ratio(Expr a, Expr b, std::vector<PointValues>& points) {
  constexpr int kLongest = 720;
  const double ratio = points[0](a) / points[0](b);
  for (PointValues& at : points)
    if (!(std::abs(at(a) - ratio * at(b)) <= 1e-10 * std::abs(at(a)))) return std::nullopt;
  for (int d = 1; d <= kLongest; ++d)
    if (const double n = ratio * d; std::abs(n) < 1e6 && std::abs(n - std::round(n)) < 1e-9 * std::abs(n)) {
      return Rational(static_cast<long>(std::round(n)), d);
    }
  return std::nullopt;
}

std::size_t number_of_nodes(Expr e) { return reachable({&e, 1}).size(); }

}  // namespace anholon
