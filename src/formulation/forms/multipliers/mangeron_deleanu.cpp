// The Mangeron-Deleanu equations with multipliers [N 5.1]:
//
//   1/m [dT^(m)/dq^(m) - (m+1) dT/dq] = Q + QR + … + Gamma + sum lambda dphi/dq^(m)
//
// m is the highest order of the constraints (1 at least), or the requested order; T^(m) = D^m T/Dt^m with frozen
// masses.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination& E) {
  return {mangeron_deleanu_operator(M, order_of(M, E)), right_side(M)};
}

static Quantities quantities(const Mechanics& M, const Elimination& E) {
  return of_mangeron_deleanu(M, order_of(M, E));
}

extern const Formulation mangeron_deleanu;
const Formulation mangeron_deleanu{"mangeron-deleanu",
                                   "Mangeron–Deleanu equations with multipliers",
                                   "(5.1)",
                                   kMicevicRusov,
                                   Unknowns::multipliers,
                                   no_obstacle,
                                   equations,
                                   quantities,
                                   kHighestM};

}  // namespace anholon::forms
