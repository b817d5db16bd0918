// The Misevic-Rusov equations in reduced kinetic energies [N 3.16]; T~ as in [L 3.15], f' = df/dt:
//
//   dT~^(m)/dq_nu^(m) - dT~^(m-1)/dq_nu^(m-1) - dT/dq_nu - sum_b dT^(m-1)/dq_b^(m) (df'_b/dq_nu^(m) - df_b/dq_nu^(m-1))
//     - sum_b (dT^(m-1)/dq_b^(m-1) + dT/dq_b) df_b/dq_nu^(m)  =  G_nu + sum_b G_b df_b/dq_nu^(m)
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination& E) {
  const Expr T_before = T(M, E.m - 1);
  const Column p = E.on(E.D(gradient(T_before, jets(*M.model, E.m))));            // dT^(m-1)/dq_b^(m)
  const Column r = E.on(E.D(gradient(T_before, jets(*M.model, E.m - 1))));        // dT^(m-1)/dq_b^(m-1)
  const Column t = E.on(gradient(M.T, M.q));
  // Term by term, as in chaplygin.cpp.
  const auto turned = E.f_rate_by_u(), f_by = E.f_by(E.m - 1), f_by_u = E.f_by_u();
  const Column first = E.by_u(T(M, E.m)), second = E.I(E.by(E.m - 1, T_before)), third = E.I(t), fourth = p * (turned - f_by), fifth = (r + E.D(t)) * f_by_u;
  return {first - second - third - fourth - fifth, E.contract(forces(M))};
}

extern const Formulation misevic_rusov_reduced;
const Formulation misevic_rusov_reduced{"misevic-rusov-reduced", "Mišević–Rusov equations in reduced energies", "(3.16)",
                                        kMisevicRusov, Unknowns::coordinates, no_obstacle, equations};

}  // namespace anholon::forms
