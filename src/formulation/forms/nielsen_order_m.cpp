// Nielsen's equations of order m with multipliers, from [L 3.10]:
//
//   m D/Dt dT^(m-1)/dq^(m) - dT^(m-1)/dq^(m-1) = Q + QR + … + Gamma + sum lambda dphi/dq^(m)
//
// m is the highest order of the constraints (1 at least); T^(k) = D^k T/Dt^k with frozen masses. For
// m = 1 these are Routh's equations.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M) {
  const unsigned m = highest_order(M);
  const Expr T_before = total_derivative(M.T, m - 1);
  const Column inertia = Rational(m) * total_derivative(gradient(T_before, jets(*M.model, m))) -
                         gradient(T_before, jets(*M.model, m - 1));
  return {inertia, right_side(M)};
}

static std::string obstacle(const Mechanics&) { return {}; }

extern const Formulation nielsen_order_m;
const Formulation nielsen_order_m{"nielsen-order-m", "Nielsen's equations of order m with multipliers", "from (3.10)",
                                  "Luo & Zhao, variable-mass systems with constraints of arbitrary order", obstacle, equations};

}  // namespace anholon::forms
