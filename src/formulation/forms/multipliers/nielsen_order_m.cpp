// Nielsen's equations of order m with multipliers, from [L 3.10]:
//
//   m D/Dt dT^(m-1)/dq^(m) - dT^(m-1)/dq^(m-1) = Q + QR + … + Gamma + sum lambda dphi/dq^(m)
//
// m is the highest order of the constraints (1 at least), or the requested order; T^(k) = D^k T/Dt^k with frozen
// masses. For m = 1 these are Routh's equations.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination& E) {
  return {nielsen_operator(M, order_of(M, E)), right_side(M)};
}

static Quantities quantities(const Mechanics& M, const Elimination& E) { return of_nielsen(M, order_of(M, E)); }

extern const Formulation nielsen_order_m;
const Formulation nielsen_order_m{"nielsen-order-m",
                                  "Nielsen's equations of order m with multipliers",
                                  "from (3.10)",
                                  kLuoZhao,
                                  Unknowns::multipliers,
                                  no_obstacle,
                                  equations,
                                  quantities,
                                  kHighestM};

}  // namespace anholon::forms
