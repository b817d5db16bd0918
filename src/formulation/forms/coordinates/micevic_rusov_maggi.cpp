// The Micevic-Rusov equations of Maggi's type [N 3.7]:
//
//   E_nu + sum_b E_b df_b/dq_nu^(m) = G_nu + sum_b G_b df_b/dq_nu^(m),
//   E = dT^(m)/dq^(m) - dT^(m-1)/dq^(m-1) - dT/dq
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination& E) {
  return {E.contract(micevic_rusov_operator(M, E.m)), E.contract(forces(M))};
}

static Quantities quantities(const Mechanics& M, const Elimination& E) {
  return listed({of_micevic_rusov(M, E.m), forces_along(M, E)});
}

extern const Formulation micevic_rusov_maggi;
const Formulation micevic_rusov_maggi{"micevic-rusov-maggi",
                                      "Mićević–Rusov equations of Maggi's type",
                                      "(3.7)",
                                      kMicevicRusov,
                                      Unknowns::coordinates,
                                      no_obstacle,
                                      equations,
                                      quantities,
                                      kHighestM};

}  // namespace anholon::forms
