// The vakonomic equations (theory: vakonomic), another mechanics: the action is stationary among the motions that
// satisfy the constraints,
//
//   D/Dt dT/dq' - dT/dq = G + sum_r sum_k (-1)^k d^k/dt^k (mu_r dphi_r/dq^(k)),   k = 0 .. m
//
// These equations agree with the ideal reactions of Chetaev and Niu only if the constraints are integrable.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination&) {
  Column reaction(M.q.size(), M.graph().zero());
  for (std::size_t r = 0; r < M.phi.size(); ++r) {
    const Expr phi = put_masses(*M.model, M.phi[r]);
    for (unsigned k = 0; k <= static_cast<unsigned>(M.order[r]); ++k) {
      const Column by_k = gradient(phi, jets(*M.model, k));
      for (std::size_t a = 0; a < by_k.size(); ++a) {
        const Expr term = total_derivative(M.lambda[r] * by_k[a], k);
        reaction[a] += k % 2 == 0 ? term : -term;
      }
    }
  }
  return {lagrange_operator(M), forces(M) + reaction};
}

static Quantities quantities(const Mechanics& M, const Elimination&) { return of_lagrange(M); }

extern const Formulation vakonomic;
const Formulation vakonomic{"vakonomic",
                            "vakonomic equations (another mechanics)",
                            "",
                            "Kozlov 1983",
                            Unknowns::variational,
                            no_obstacle,
                            equations,
                            quantities};

}  // namespace anholon::forms
