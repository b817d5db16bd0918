// Routh's equations for a variable-mass system with constraints of any order, seen by a noninertial
// observer [L 2.7]:
//
//   D/Dt dT/dq' - dT/dq = Q + QR + Qomega - d(V_O + V_omega)/dq + Gamma + sum lambda dphi/dq^(m)
//
// D/Dt and all partial derivatives with frozen masses. Unknown: q'' and lambda.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M) {
  return {total_derivative(gradient(M.T, M.qd)) - gradient(M.T, M.q), right_side(M)};
}

static std::string obstacle(const Mechanics&) { return {}; }

extern const Formulation routh;
const Formulation routh{"routh", "Routh's equations with multipliers", "(2.7)",
                        "Luo & Zhao, variable-mass systems with constraints of arbitrary order", obstacle, equations};

}  // namespace anholon::forms
