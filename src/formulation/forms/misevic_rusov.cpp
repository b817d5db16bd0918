// The Misevic-Rusov equations with multipliers [N 3.4]; without constraints [N 3.1]:
//
//   dT^(m)/dq^(m) - dT^(m-1)/dq^(m-1) - dT/dq = Q + QR + … + Gamma + sum lambda dphi/dq^(m)
//
// m is the highest order of the constraints (1 at least); T^(k) = D^k T/Dt^k with frozen masses. All
// jets are independent; q^(m+1) drops out of the left side.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M) {
  const unsigned m = highest_order(M);
  const Expr T_before = total_derivative(M.T, m - 1), T_m = total_derivative(T_before);
  const Column inertia = gradient(T_m, jets(*M.model, m)) - gradient(T_before, jets(*M.model, m - 1)) - gradient(M.T, M.q);
  return {inertia, right_side(M)};
}

static std::string obstacle(const Mechanics&) { return {}; }

extern const Formulation misevic_rusov;
const Formulation misevic_rusov{"misevic-rusov", "Mišević–Rusov equations with multipliers", "(3.1), (3.4)",
                                "third paper on Mišević–Rusov equations of higher-order systems", obstacle, equations};

}  // namespace anholon::forms
