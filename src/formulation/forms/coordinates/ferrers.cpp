// Ferrers' equations (theory: classics), for constraints of order 1:
//
//   D/Dt dT~/dq_nu' - sum_b dT/dq_b' d/dt df_b/dq_nu' - dT/dq_nu - sum_b dT/dq_b df_b/dq_nu'  =  G_nu + sum_b G_b df_b/dq_nu'
//
// T~ is T with q_D' = f substituted; everywhere else T is not reduced.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination& E) {
  const Column p = E.on(E.D(gradient(M.T, M.qd)));
  // The terms are computed one by one, as in chaplygin.cpp.
  const Column first = E.rate(E.by_u(E.on(M.T))), second = p * E.rate(E.f_by_u()),
               third = E.contract(gradient(M.T, M.q));
  return {first - second - third, E.contract(forces(M))};
}

static Quantities quantities(const Mechanics& M, const Elimination& E) {
  const Label tilde = energy("T", 0, Over::tilde);
  const Column p = E.by_u(E.on(M.T));
  const Quantities momenta = named(partial(tilde, free_labels(M, E)), p);
  return listed({named(energy("T"), M.T), reduced(E, tilde, M.T), momenta, frozen_rates(momenta, E.rate(p)),
                 dependent_partials(M, E, energy("T"), M.T, 1), rates_of_f_by_u(M, E),
                 named(partial(energy("T"), jet_labels(M, 0)), E.on(gradient(M.T, M.q))), forces_along(M, E)});
}

extern const Formulation ferrers;
const Formulation ferrers{"ferrers", "Ferrers' equations", "", "Ferrers 1873", Unknowns::coordinates, first_order_only,
                          equations, quantities,           1};

}  // namespace anholon::forms
