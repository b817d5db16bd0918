// Appell's equations with multipliers [L 3.18']:
//
//   dS/dq'' = Q + QR + Qomega - d(V_O + V_omega)/dq + Gamma + sum lambda dphi/dq^(m)
//
// S = sum 1/2 m |a|^2 with relative accelerations and frozen masses; the partial derivative is by q'' for every order
// of the constraints.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination&) { return {gradient(M.S, M.qdd), right_side(M)}; }

static Quantities quantities(const Mechanics& M, const Elimination&) { return of_appell(M); }

extern const Formulation appell;
const Formulation appell{"appell",
                         "Appell's equations with multipliers",
                         "(3.18')",
                         kLuoZhao,
                         Unknowns::multipliers,
                         no_obstacle,
                         equations,
                         quantities};

}  // namespace anholon::forms
