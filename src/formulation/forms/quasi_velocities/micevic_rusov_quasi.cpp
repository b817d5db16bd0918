// The Micevic-Rusov equations in quasi-coordinates [N 4.5]:
//
//   sum_s (dT^(m)/dq_s^(m) - dT^(m-1)/dq_s^(m-1) - dT/dq_s - G_s) B_sa = 0
//
// B_sa = dg_s/du_a, where q^(m) = g(q, …, q^(m-1), u, t) are the constraints and the quasi-velocities u solved [N 4.2,
// 4.3].
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination& E) {
  return {E.contract(micevic_rusov_operator(M, E.m)), E.contract(forces(M))};
}

static Quantities quantities(const Mechanics& M, const Elimination& E) {
  return listed({of_micevic_rusov(M, E.m), forces_along(M, E)});
}

extern const Formulation micevic_rusov_quasi;
const Formulation micevic_rusov_quasi{"micevic-rusov-quasi",
                                      "Mićević–Rusov equations in quasi-coordinates",
                                      "(4.5)",
                                      kMicevicRusov,
                                      Unknowns::quasi_velocities,
                                      no_obstacle,
                                      equations,
                                      quantities,
                                      kHighestM};

}  // namespace anholon::forms
