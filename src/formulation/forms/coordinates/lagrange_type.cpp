// Equations of Lagrange's type, multipliers eliminated by the matrix of the constraints [L 3.7]:
//
//   a_nu + sum_b C_b,nu a_b = 0,   a = D/Dt dT/dq' - dT/dq - G,   C = -Phi_D^-1 Phi_I
//
// Phi = dphi/dq^(m); D are the dependent, I the independent coordinates nu. G = Q + QR + Qomega - d(V_O + V_omega)/dq +
// Gamma. With B = (1, C) this is B^T a = 0 [L 3.2, 3.3, 3.4, 3.5, 3.6]; printed, (3.7) has the sum on the right with a
// minus.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination& E) {
  const Rows C = E.C();
  const Column inertia = lagrange_operator(M), G = forces(M);
  const Column by_C = E.on(E.D(inertia)) * C, first = E.on(E.I(inertia));
  const Column G_by_C = E.on(E.D(G)) * C, G_first = E.on(E.I(G));
  return {first + by_C, G_first + G_by_C};
}

static Quantities quantities(const Mechanics& M, const Elimination& E) {
  return listed({of_lagrange(M), forces_along(M, E)});
}

extern const Formulation lagrange_type;
const Formulation lagrange_type{"lagrange-type",
                                "Lagrange's equations, multipliers eliminated",
                                "(3.7)",
                                kLuoZhao,
                                Unknowns::coordinates,
                                no_obstacle,
                                equations,
                                quantities,
                                kHighestM};

}  // namespace anholon::forms
