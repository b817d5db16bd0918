// Tzenoff's equations with multipliers, the Mangeron-Deleanu equations [N 5.1] with m = 2:
//
//   1/2 [dT''/dq'' - 3 dT/dq] = Q + QR + … + Gamma + sum lambda dphi/dq^(m)
//
// for every order of the constraints. With another requested m, they are Tzenoff's equations of higher order: [N 5.1]
// with that m.
#include "formulation/formulation.h"

namespace anholon::forms {

static unsigned order(const Elimination& E) { return E.asked ? E.asked : 2; }

static Equations equations(const Mechanics& M, const Elimination& E) {
  return {mangeron_deleanu_operator(M, order(E)), right_side(M)};
}

static Quantities quantities(const Mechanics& M, const Elimination& E) { return of_mangeron_deleanu(M, order(E)); }

extern const Formulation tzenoff;
const Formulation tzenoff{
    "tzenoff",
    "Tzénoff's equations with multipliers",
    "(5.1), m = 2",
    "Tzénoff; a paper on equations of Mićević–Rusov type for nonholonomic systems of higher order",
    Unknowns::multipliers,
    no_obstacle,
    equations,
    quantities,
    kHighestM};

}  // namespace anholon::forms
