// Nielsen's equations of order m without multipliers [L 3.11]: Maggi's contraction of [L 3.10],
//
//   E_nu + sum_b E_b df_b/dq_nu^(m) = G_nu + sum_b G_b df_b/dq_nu^(m),
//   E = m D/Dt dT^(m-1)/dq^(m) - dT^(m-1)/dq^(m-1)
//
// G = Q + QR + Qomega - d(V_O + V_omega)/dq + Gamma.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination& E) {
  return {E.contract(nielsen_operator(M, E.m)), E.contract(forces(M))};
}

static Quantities quantities(const Mechanics& M, const Elimination& E) {
  return listed({of_nielsen(M, E.m), forces_along(M, E)});
}

extern const Formulation nielsen_type;
const Formulation nielsen_type{"nielsen-type",
                               "Nielsen's equations of order m without multipliers",
                               "(3.11)",
                               kLuoZhao,
                               Unknowns::coordinates,
                               no_obstacle,
                               equations,
                               quantities,
                               kHighestM};

}  // namespace anholon::forms
