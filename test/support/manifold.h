// Points on the manifold of the constraints. All free symbols are pseudo-random; Newton's method on the (lifted)
// constraints themselves finds the dependent highest derivatives, and on the derivative of the constraints those of the
// next order. Of an Elimination only the list of coordinates is used.
#pragma once
#include <optional>

#include "mechanics/elimination.h"
#include "numeric/linear.h"
#include "support/model_point.h"

namespace anholon::test {

inline Matrix<Multi> values_of(const Rows& rows, const Point& at) {
  Matrix<Multi> m(rows.size(), rows.empty() ? 0 : rows[0].size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::vector<Multi> v = values(rows[i], at);
    for (std::size_t j = 0; j < v.size(); ++j) m(i, j) = v[j];
  }
  return m;
}

// Solves the equations for the unknown symbols by Newton's method; false if it does not converge.
inline bool solve_for(Point& at, const Column& equations, const Column& unknowns) {
  Rows jacobian;
  for (Expr e : equations) jacobian.push_back(gradient(e, unknowns));
  for (int k = 0; k < 40; ++k) {
    const std::vector<Multi> r = values(equations, at);
    Lu<Multi> lu;
    std::vector<Multi> step;
    if (!lu.factor(values_of(jacobian, at))) return false;
    lu.solve(r, step);
    double largest = 0;
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
      const Multi before = values({&unknowns[i], 1}, at)[0];
      at.set(unknowns[i], before - step[i]);
      largest = std::max(largest, std::abs(to_double(step[i])) / (1 + std::abs(to_double(before))));
    }
    if (!(largest < 1e6)) return false;
    if (largest < 1e-36) return true;
  }
  return false;
}

inline std::optional<Point> manifold_point(const Model& model, const Elimination& e, std::uint64_t seed) {
  for (std::uint64_t k = 0; k < 30; ++k) {
    Point at = random_point(model, seed + 1000 * k);
    Column top, next;
    for (std::size_t b : e.dependent) {
      top.push_back(model.graph->jet(static_cast<std::uint32_t>(b), e.m));
      next.push_back(model.graph->jet(static_cast<std::uint32_t>(b), e.m + 1));
    }
    if (e.phi.empty()) return at;
    if (!solve_for(at, e.phi, top)) continue;
    if (solve_for(at, total_derivative(e.phi), next)) return at;
  }
  return std::nullopt;
}

// dq^(m)/du on the manifold, n x (n - s), from the constraints and the free quantities alone.
inline Matrix<Multi> tangents(const Model& model, const Elimination& e, const Point& at) {
  const Column top = jets(model, e.m);
  Column w;
  if (e.quasi) {
    w = e.quasi->w;
  } else {
    for (std::size_t a : e.independent) w.push_back(top[a]);
    w.insert(w.end(), e.phi.begin(), e.phi.end());
  }
  Rows rows;
  for (Expr x : w) rows.push_back(gradient(x, top));
  Lu<Multi> lu;
  Matrix<Multi> B(top.size(), top.size() - e.phi.size());
  if (!lu.factor(values_of(rows, at))) return B;
  for (std::size_t a = 0; a < B.cols; ++a) {
    std::vector<Multi> unit(top.size(), Multi(0)), column;
    unit[a] = Multi(1);
    lu.solve(unit, column);
    for (std::size_t s = 0; s < top.size(); ++s) B(s, a) = column[s];
  }
  return B;
}

}  // namespace anholon::test
