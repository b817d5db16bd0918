// Appell's equations without multipliers [L 3.19]:
//
//   dS/dq''_nu + sum_b dS/dq''_b df_b/dq_nu^(m) = G_nu + sum_b G_b df_b/dq_nu^(m)
//
// S = sum 1/2 m |a|^2; the derivatives of S are by q'' for every m [L 3.16, 3.17]. G = Q + QR + Qomega - d(V_O +
// V_omega)/dq + Gamma.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination& E) {
  return {E.contract(gradient(M.S, M.qdd)), E.contract(forces(M))};
}

static Quantities quantities(const Mechanics& M, const Elimination& E) {
  return listed({of_appell(M), forces_along(M, E)});
}

extern const Formulation appell_type;
const Formulation appell_type{"appell-type",
                              "Appell's equations without multipliers",
                              "(3.19)",
                              kLuoZhao,
                              Unknowns::coordinates,
                              no_obstacle,
                              equations,
                              quantities,
                              kHighestM};

}  // namespace anholon::forms
