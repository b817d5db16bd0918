// Nielsen's equations, classical, with multipliers (Mangeron-Deleanu and Micevic-Rusov for m = 1):
//
//   dT'/dq' - 2 dT/dq = Q + QR + Qomega - d(V_O + V_omega)/dq + Gamma + sum lambda dphi/dq^(m)
//
// T' = DT/Dt with frozen masses.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination&) {
  const Column by_q = Rational(2) * gradient(M.T, M.q);
  return {gradient(T(M, 1), M.qd) - by_q, right_side(M)};
}

static Quantities quantities(const Mechanics& M, const Elimination&) { return of_mangeron_deleanu(M, 1); }

extern const Formulation nielsen;
const Formulation nielsen{
    "nielsen",
    "Nielsen's equations with multipliers",
    "(5.1), m = 1",
    "Nielsen; a paper on equations of Mićević–Rusov type for nonholonomic systems of higher order",
    Unknowns::multipliers,
    no_obstacle,
    equations,
    quantities};

}  // namespace anholon::forms
