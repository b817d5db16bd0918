// The Gibbs-Appell equations in quasi-velocities (theory: classics), for constraints of order 1:
//
//   dS*/du_a' = sum_s G_s B_sa
//
// S* is S with q' = g and q'' = dg/dt put in.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination& E) {
  return {E.by_u_rate(M.S), E.contract(forces(M))};
}

extern const Formulation gibbs_appell;
const Formulation gibbs_appell{"gibbs-appell", "Gibbs–Appell equations", "",
                               "Gibbs 1879, Appell 1899", Unknowns::quasi_velocities, first_order_only, equations};

}  // namespace anholon::forms
