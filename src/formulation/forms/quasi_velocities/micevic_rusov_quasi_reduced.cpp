// The Micevic-Rusov equations in quasi-coordinates, reduced [N 4.11]. T*^(k) is T^(k) with q^(m) = g, q^(m+1) = g' =
// dg/dt substituted [N 4.9, 4.10]:
//
//   dT*^(m)/du_a - dT*^(m-1)/dpi_a^(m-1) - dT/dpi_a - sum_s dT^(m-1)/dq_s^(m) (dg'_s/du_a - dg_s/dpi_a^(m-1)) = sum_s G_s B_sa
//
// d/dpi_a := sum_s d/dq_s B_sa and d/dpi_a^(m-1) := sum_s d/dq_s^(m-1) B_sa are definitions, no partial derivatives [N
// 4.7, 4.8].
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination& E) {
  const Expr T_before = T(M, E.m - 1);
  const Column p = E.on(gradient(T_before, jets(*M.model, E.m)));  // dT^(m-1)/dq_s^(m)
  Rows g_by_pi;                                                    // dg_s/dpi_a^(m-1)
  for (const Column& row : E.g_by(E.m - 1)) g_by_pi.push_back(E.contract(row));
  // The terms are computed one by one, as in chaplygin.cpp.
  const Column first = E.by_u(T(M, E.m)), second = E.contract(E.by(E.m - 1, T_before)),
               third = E.contract(gradient(M.T, M.q)), fourth = p * (E.g_rate_by_u() - g_by_pi);
  return {first - second - third - fourth, E.contract(forces(M))};
}

static Quantities quantities(const Mechanics& M, const Elimination& E) {
  const Expr T_before = T(M, E.m - 1), T_m = T(M, E.m);
  const Label before = energy("T", E.m - 1), star = energy("T", E.m - 1, Over::star),
              star_m = energy("T", E.m, Over::star);
  const Labels q_m = jet_labels(M, E.m);
  Labels pi, pi_below;  // labels of the operators d/dpi and d/dpi^(m-1)
  for (const std::string& u : E.free.names) {
    pi.push_back(indexed(energy("pi"), u, {name_of(*M.model, u)}));
    pi_below.push_back(indexed(energy("pi", E.m - 1), u, {name_of(*M.model, u)}));
  }
  Rows g_by_pi;
  for (const Column& row : E.g_by(E.m - 1)) g_by_pi.push_back(E.contract(row));
  return listed({named(before, T_before), reduced(E, star, T_before), reduced(E, star_m, T_m),
                 named(partial(star_m, free_labels(M, E)), E.by_u(T_m)),
                 named(partial(star, pi_below), E.contract(E.by(E.m - 1, T_before))),
                 named(partial(energy("T"), pi), E.contract(gradient(M.T, M.q))),
                 named(partial(before, q_m), E.on(gradient(T_before, jets(*M.model, E.m)))),
                 partials(jet_labels(M, E.m + 1), free_labels(M, E), E.g_rate_by_u()), partials(q_m, pi_below, g_by_pi),
                 forces_along(M, E)});
}

extern const Formulation micevic_rusov_quasi_reduced;
const Formulation micevic_rusov_quasi_reduced{"micevic-rusov-quasi-reduced",
                                              "Mićević–Rusov equations in quasi-coordinates, reduced",
                                              "(4.11)",
                                              kMicevicRusov,
                                              Unknowns::quasi_velocities,
                                              no_obstacle,
                                              equations,
                                              quantities,
                                              kHighestM};

}  // namespace anholon::forms
