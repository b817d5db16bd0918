// Appell's equations in the reduced energy of accelerations [L 3.20, 3.21], as they must read:
//
//   m = 1:   dS~/dq''_nu = G_nu + sum_b G_b df_b/dq_nu'          with q_D'' = df/dt put into S
//   m >= 2:  dS~/dq_nu^(m) = G_nu + sum_b G_b df_b/dq_nu^(m)     with q_D^(m) = f put into S^(m-2) = D^(m-2) S/Dt^(m-2)
//
// The paper prints S itself for every m, which is right for m = 2 only.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination& E) {
  const Column inertia = E.m == 1 ? E.by_u_rate(M.S) : E.by_u(total_derivative(M.S, E.m - 2));
  return {inertia, E.contract(forces(M))};
}

static Quantities quantities(const Mechanics& M, const Elimination& E) {
  const unsigned k = E.m == 1 ? 0 : E.m - 2;
  const Expr S = total_derivative(M.S, k);
  const Label tilde = energy("S", k, Over::tilde);
  return listed({reduced(E, tilde, S),
                 named(partial(tilde, free_labels(M, E, E.m == 1 ? 1 : 0)), E.m == 1 ? E.by_u_rate(S) : E.by_u(S)),
                 forces_along(M, E)});
}

extern const Formulation appell_reduced;
const Formulation appell_reduced{"appell-reduced",
                                 "Appell's equations in the reduced energy of accelerations",
                                 "(3.21), corrected",
                                 kLuoZhao,
                                 Unknowns::coordinates,
                                 no_obstacle,
                                 equations,
                                 quantities,
                                 kHighestM};

}  // namespace anholon::forms
