// Points of a motion. Routh's equations [L 2.7] hold, and so do the constraints and those of their derivatives that
// contain accelerations or derivatives of the constraint's own order. All other values are pseudo-random: those that
// may be prescribed at a start, and derivatives that follow only from derivatives of the equations of motion.
#pragma once
#include "formulation/formulation.h"
#include "support/manifold.h"

namespace anholon::test {

// Needs constraints of one order, as many as `dependent` has coordinates. They are lifted to order m if m is higher.
inline std::optional<Point> motion_point(const Mechanics& M, const std::vector<std::size_t>& dependent, unsigned m,
                                         std::uint64_t seed) {
  const Model& model = *M.model;
  const unsigned order = M.order.empty() ? 0 : static_cast<unsigned>(M.order[0]), top = std::max({m, order, 2U});
  Column lower, lower_unknown, equations, unknowns;
  const auto add = [&](unsigned k, Column& to, Column& symbols) {
    for (Expr phi : M.phi) to.push_back(total_derivative(put_masses(model, phi), k - order));
    if (k != 2)
      for (std::size_t b : dependent) symbols.push_back(model.graph->jet(static_cast<std::uint32_t>(b), k));
  };
  for (unsigned k = order; !M.phi.empty() && k < 2; ++k) add(k, lower, lower_unknown);
  for (unsigned k = std::max(order, 2U); !M.phi.empty() && k <= top; ++k) add(k, equations, unknowns);
  const Column routh = put_masses(model, lagrange_operator(M) - right_side(M)), accelerations = jets(model, 2);
  equations.insert(equations.end(), routh.begin(), routh.end());
  unknowns.insert(unknowns.end(), accelerations.begin(), accelerations.end());
  if (order <= 2) unknowns.insert(unknowns.end(), M.lambda.begin(), M.lambda.end());
  for (std::uint64_t k = 0; k < 30; ++k) {
    Point at = random_point(model, seed + 1000 * k);
    if ((lower.empty() || solve_for(at, lower, lower_unknown)) && solve_for(at, equations, unknowns)) return at;
  }
  return std::nullopt;
}

}  // namespace anholon::test
