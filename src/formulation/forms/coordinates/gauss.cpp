// Gauss' principle of least compulsion (theory: classics): among the accelerations that the constraints allow, the true
// ones make
//
//   Z = S - sum_a G_a q_a''     (the compulsion sum 1/2 m |a - F/m|^2 up to terms without q'')
//
// stationary: dZ/dq''_nu along the constraints is zero. The constraints are taken at the level of accelerations: those
// of order 1 are differentiated once, those of order 0 twice. For order 3 and more the principle would define another
// mechanics.
#include "formulation/formulation.h"

namespace anholon::forms {

static std::string up_to_accelerations(const Mechanics& M) {
  for (std::size_t r = 0; r < M.order.size(); ++r)
    if (M.order[r] > 2)
      return "the constraint '" + M.model->constraints[r].name + "' is of order " + std::to_string(M.order[r]) +
             ": beyond accelerations the principle says something else";
  return {};
}

static Equations equations(const Mechanics& M, const Elimination& E) {
  // dZ = dS - sum_a G_a dq_a'': the forces are held while Z is varied.
  const Column dS = E.m == 1 ? E.by_u_rate(M.S) : E.by_u(M.S);
  return {dS, E.contract(forces(M))};
}

static Quantities quantities(const Mechanics& M, const Elimination& E) {
  const Label tilde = energy("S", 0, Over::tilde);
  return listed({reduced(E, tilde, M.S),
                 named(partial(tilde, free_labels(M, E, E.m == 1 ? 1 : 0)), E.m == 1 ? E.by_u_rate(M.S) : E.by_u(M.S)),
                 forces_along(M, E)});
}

extern const Formulation gauss;
const Formulation gauss{"gauss",
                        "Gauss' principle of least compulsion",
                        "",
                        "Gauss 1829",
                        Unknowns::coordinates,
                        up_to_accelerations,
                        equations,
                        quantities,
                        2};

}  // namespace anholon::forms
