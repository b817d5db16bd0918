// The Micevic-Rusov equations with multipliers [N 3.4]; without constraints [N 3.1]:
//
//   dT^(m)/dq^(m) - dT^(m-1)/dq^(m-1) - dT/dq = Q + QR + … + Gamma + sum lambda dphi/dq^(m)
//
// m is the highest order of the constraints (1 at least), or the requested order; T^(k) = D^k T/Dt^k with frozen
// masses. All jets are independent; q^(m+1) drops out of the left side.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination& E) {
  return {micevic_rusov_operator(M, order_of(M, E)), right_side(M)};
}

static Quantities quantities(const Mechanics& M, const Elimination& E) { return of_micevic_rusov(M, order_of(M, E)); }

extern const Formulation micevic_rusov;
const Formulation micevic_rusov{"micevic-rusov",
                                "Mićević–Rusov equations with multipliers",
                                "(3.1), (3.4)",
                                kMicevicRusov,
                                Unknowns::multipliers,
                                no_obstacle,
                                equations,
                                quantities,
                                kHighestM};

}  // namespace anholon::forms
