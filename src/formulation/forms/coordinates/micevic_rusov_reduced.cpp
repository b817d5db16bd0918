// The Micevic-Rusov equations in reduced kinetic energies [N 3.16]; T~ as in [L 3.15], f' = df/dt:
//
//   dT~^(m)/dq_nu^(m) - dT~^(m-1)/dq_nu^(m-1) - dT/dq_nu - sum_b dT^(m-1)/dq_b^(m) (df'_b/dq_nu^(m) - df_b/dq_nu^(m-1))
//     - sum_b (dT^(m-1)/dq_b^(m-1) + dT/dq_b) df_b/dq_nu^(m)  =  G_nu + sum_b G_b df_b/dq_nu^(m)
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination& E) {
  const Expr T_before = T(M, E.m - 1);
  const Column p = E.on(E.D(gradient(T_before, jets(*M.model, E.m))));      // dT^(m-1)/dq_b^(m)
  const Column r = E.on(E.D(gradient(T_before, jets(*M.model, E.m - 1))));  // dT^(m-1)/dq_b^(m-1)
  const Column t = E.on(gradient(M.T, M.q));
  // The terms are computed one by one, as in chaplygin.cpp.
  const auto turned = E.f_rate_by_u(), f_by = E.f_by(E.m - 1), f_by_u = E.f_by_u();
  const Column first = E.by_u(T(M, E.m)), second = E.I(E.by(E.m - 1, T_before)), third = E.I(t),
               fourth = p * (turned - f_by), fifth = (r + E.D(t)) * f_by_u;
  return {first - second - third - fourth - fifth, E.contract(forces(M))};
}

static Quantities quantities(const Mechanics& M, const Elimination& E) {
  const Expr T_before = T(M, E.m - 1), T_m = T(M, E.m);
  const Label before = energy("T", E.m - 1), tilde = energy("T", E.m - 1, Over::tilde),
              tilde_m = energy("T", E.m, Over::tilde);
  const Quantities below = dependent_partials(M, E, before, T_before, E.m - 1);
  return listed({named(before, T_before), reduced(E, tilde, T_before), reduced(E, tilde_m, T_m),
                 named(partial(tilde_m, free_labels(M, E)), E.by_u(T_m)),
                 named(partial(tilde, pick(jet_labels(M, E.m - 1), E.independent)), E.I(E.by(E.m - 1, T_before))),
                 named(partial(energy("T"), jet_labels(M, 0)), E.on(gradient(M.T, M.q))),
                 dependent_partials(M, E, before, T_before, E.m), E.m == 1 ? Quantities{} : below, f_rate_by_u(M, E),
                 f_by_lower(M, E), forces_along(M, E)});
}

extern const Formulation micevic_rusov_reduced;
const Formulation micevic_rusov_reduced{"micevic-rusov-reduced",
                                        "Mićević–Rusov equations in reduced energies",
                                        "(3.16)",
                                        kMicevicRusov,
                                        Unknowns::coordinates,
                                        no_obstacle,
                                        equations,
                                        quantities,
                                        kHighestM};

}  // namespace anholon::forms
