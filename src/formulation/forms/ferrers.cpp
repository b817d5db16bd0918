// Ferrers' equations (theory: classics), for constraints of order 1:
//
//   D/Dt dT~/dq_nu' - sum_b dT/dq_b' d/dt df_b/dq_nu' - dT/dq_nu - sum_b dT/dq_b df_b/dq_nu'  =  G_nu + sum_b G_b df_b/dq_nu'
//
// T~ is T with q_D' = f put in; everywhere else T is not reduced.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination& E) {
  const Column p = E.on(E.D(gradient(M.T, M.qd)));
  // Term by term, as in chaplygin.cpp.
  const Column first = E.rate(E.by_u(E.on(M.T))), second = p * E.rate(E.f_by_u()), third = E.contract(gradient(M.T, M.q));
  return {first - second - third, E.contract(forces(M))};
}

extern const Formulation ferrers;
const Formulation ferrers{"ferrers", "Ferrers' equations", "", "Ferrers 1873", Unknowns::coordinates, first_order_only, equations};

}  // namespace anholon::forms
