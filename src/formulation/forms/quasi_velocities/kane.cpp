// Kane's equations (theory: classics), for any m: generalized active and inertia forces along the partial velocities,
//
//   sum_i (F_i - m_i a_i) . dv_i/du_a = 0,   dv_i/du_a = sum_s dv_i/dq_s' B_sa
//
// F_i holds the given, reactive and fictitious forces; forces without a place (potentials, generalized) enter through
// G.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination& E) {
  Column outputs, inertia_forces;
  for (const WeightedPoint& point : M.points) {
    const Vector v = total_derivative(point.place), a = total_derivative(v);
    for (int i = 0; i < 3; ++i) {
      outputs.push_back(v[i]);
      inertia_forces.push_back(point.weight * a[i]);
    }
  }
  return {E.contract(pullback(outputs, inertia_forces, M.qd)), E.contract(forces(M))};
}

static Quantities quantities(const Mechanics& M, const Elimination& E) {
  Column v;
  for (const WeightedPoint& point : M.points)
    for (int i = 0; i < 3; ++i) v.push_back(total_derivative(point.place[i]));
  const Labels of_v = point_labels(M, letter("v"));
  Rows by_u;  // partial velocities
  for (Expr e : v) by_u.push_back(E.contract(gradient(e, M.qd)));
  return listed({named(of_v, v), partials(of_v, free_labels(M, E), by_u),
                 named(point_labels(M, letter("a")), total_derivative(v)), forces_along(M, E)});
}

extern const Formulation kane;
const Formulation kane{
    "kane",    "Kane's equations", "",       "Kane & Levinson 1985", Unknowns::quasi_velocities, no_obstacle,
    equations, quantities,         kHighestM};

}  // namespace anholon::forms
