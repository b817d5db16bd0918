// Tzenoff's equations with multipliers, the Mangeron-Deleanu equations [N 5.1] with m = 2:
//
//   1/2 [dT''/dq'' - 3 dT/dq] = Q + QR + … + Gamma + sum lambda dphi/dq^(m)
//
// whatever the order of the constraints.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination&) {
  return {mangeron_deleanu_operator(M, 2), right_side(M)};
}

extern const Formulation tzenoff;
const Formulation tzenoff{"tzenoff", "Tzénoff's equations with multipliers", "(5.1), m = 2",
                          "Tzénoff; third paper on Mišević–Rusov equations", Unknowns::multipliers, no_obstacle, equations};

}  // namespace anholon::forms
