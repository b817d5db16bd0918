// Maggi's equations for constraints of any order [L 3.9]:
//
//   E_nu - G_nu + sum_b (E_b - G_b) df_b/dq_nu^(m) = 0,   E = D/Dt dT/dq' - dT/dq
//
// with q_D^(m) = f [L 3.8]. G = Q + QR + Qomega - d(V_O + V_omega)/dq + Gamma.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination& E) {
  return {E.contract(lagrange_operator(M)), E.contract(forces(M))};
}

static Quantities quantities(const Mechanics& M, const Elimination& E) {
  return listed({of_lagrange(M), forces_along(M, E)});
}

extern const Formulation maggi;
const Formulation maggi{"maggi",     "Maggi's equations", "(3.9)",    kLuoZhao, Unknowns::coordinates,
                        no_obstacle, equations,           quantities, kHighestM};

}  // namespace anholon::forms
