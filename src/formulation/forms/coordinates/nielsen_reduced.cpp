// Nielsen's equations, generalized to order m, in reduced kinetic energies [L 3.15]. T~^(k) is T^(k) with q_D^(m) = f
// and q_D^(m+1) = df/dt substituted before the partial derivatives are taken [L 3.14]:
//
//   m dT~^(m)/dq_nu^(m) - (m+1) dT~^(m-1)/dq_nu^(m-1) - (m+1) sum_b dT^(m-1)/dq_b^(m-1) df_b/dq_nu^(m)
//     - sum_b dT^(m-1)/dq_b^(m) (m d(df_b/dt)/dq_nu^(m) - (m+1) df_b/dq_nu^(m-1))  =  G_nu + sum_b G_b df_b/dq_nu^(m)
//
// In the sums T is not reduced.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination& E) {
  const Rational m(E.m), m1(E.m + 1);
  const Expr T_before = T(M, E.m - 1);
  const Column p = E.on(E.D(gradient(T_before, jets(*M.model, E.m))));      // dT^(m-1)/dq_b^(m)
  const Column r = E.on(E.D(gradient(T_before, jets(*M.model, E.m - 1))));  // dT^(m-1)/dq_b^(m-1)
  // The terms are computed one by one, as in chaplygin.cpp.
  const auto turned = m * E.f_rate_by_u(), f_by = m1 * E.f_by(E.m - 1);
  const Column first = m * E.by_u(T(M, E.m)), second = m1 * E.I(E.by(E.m - 1, T_before)), third = m1 * (r * E.f_by_u()),
               fourth = p * (turned - f_by);
  return {first - second - third - fourth, E.contract(forces(M))};
}

static Quantities quantities(const Mechanics& M, const Elimination& E) {
  const Expr T_before = T(M, E.m - 1), T_m = T(M, E.m);
  const Label before = energy("T", E.m - 1), tilde = energy("T", E.m - 1, Over::tilde),
              tilde_m = energy("T", E.m, Over::tilde);
  return listed({named(before, T_before), reduced(E, tilde, T_before), reduced(E, tilde_m, T_m),
                 named(partial(tilde_m, free_labels(M, E)), E.by_u(T_m)),
                 named(partial(tilde, pick(jet_labels(M, E.m - 1), E.independent)), E.I(E.by(E.m - 1, T_before))),
                 dependent_partials(M, E, before, T_before, E.m), dependent_partials(M, E, before, T_before, E.m - 1),
                 f_rate_by_u(M, E), f_by_lower(M, E), forces_along(M, E)});
}

extern const Formulation nielsen_reduced;
const Formulation nielsen_reduced{"nielsen-reduced",
                                  "Nielsen's equations in reduced energies, generalized to order m",
                                  "(3.15)",
                                  kLuoZhao,
                                  Unknowns::coordinates,
                                  no_obstacle,
                                  equations,
                                  quantities,
                                  kHighestM};

}  // namespace anholon::forms
