// Routh's equations for a variable-mass system with constraints of any order, seen by a noninertial
// observer [L 2.7]:
//
//   D/Dt dT/dq' - dT/dq = Q + QR + Qomega - d(V_O + V_omega)/dq + Gamma + sum lambda dphi/dq^(m)
//
// D/Dt and all partial derivatives with frozen masses. Unknown: q'' and lambda.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination&) { return {lagrange_operator(M), right_side(M)}; }

static Quantities quantities(const Mechanics& M, const Elimination&) { return of_lagrange(M); }

extern const Formulation routh;
const Formulation routh{
    "routh",   "Routh's equations with multipliers", "(2.7)", kLuoZhao, Unknowns::multipliers, no_obstacle, equations,
    quantities};

}  // namespace anholon::forms
