// The Gibbs-Appell equations in quasi-velocities (theory: classics), for constraints of order 1:
//
//   dS*/du_a' = sum_s G_s B_sa
//
// S* is S with q' = g and q'' = dg/dt substituted.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination& E) {
  return {E.by_u_rate(M.S), E.contract(forces(M))};
}

static Quantities quantities(const Mechanics& M, const Elimination& E) {
  const Label star = energy("S", 0, Over::star);
  return listed(
      {reduced(E, star, M.S), named(partial(star, free_labels(M, E, 1)), E.by_u_rate(M.S)), forces_along(M, E)});
}

extern const Formulation gibbs_appell;
const Formulation gibbs_appell{"gibbs-appell",
                               "Gibbs–Appell equations",
                               "",
                               "Gibbs 1879, Appell 1899",
                               Unknowns::quasi_velocities,
                               first_order_only,
                               equations,
                               quantities,
                               1};

}  // namespace anholon::forms
