// Voronets' equations (theory: classics), for constraints of order 1, q_D' = f(q, q_I', t) of any shape. With Theta = T
// where q_D' = f is substituted, theta_b = dT/dq_b':
//
//   D/Dt dTheta/dq_nu' - dTheta/dq_nu - sum_b dTheta/dq_b df_b/dq_nu'
//     - sum_b theta_b (d/dt df_b/dq_nu' - df_b/dq_nu - sum_c df_b/dq_c df_c/dq_nu')  =  G_nu + sum_b G_b df_b/dq_nu'
//
// In Chaplygin's own case no dependent coordinate occurs anywhere.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination& E) {
  const Expr Theta = E.on(M.T);
  const Column theta = E.on(E.D(gradient(M.T, M.qd)));
  Rows along;  // df_b/dq_nu + sum_c df_b/dq_c df_c/dq_nu'
  for (std::size_t b : E.dependent) along.push_back(E.contract(E.g_by(0)[b]));
  // The terms are computed one by one, as in chaplygin.cpp.
  const auto turned = E.rate(E.f_by_u());
  const Column first = E.rate(E.by_u(Theta)), second = E.contract(E.by(0, Theta)), third = theta * (turned - along);
  return {first - second - third, E.contract(forces(M))};
}

static Quantities quantities(const Mechanics& M, const Elimination& E) {
  const Label name = letter("Theta");
  const Expr Theta = E.on(M.T);
  const Column p = E.by_u(Theta);
  const Quantities momenta = named(partial(name, free_labels(M, E)), p);
  Rows f_by_q;
  for (std::size_t b : E.dependent) f_by_q.push_back(E.g_by(0)[b]);
  return listed({named(energy("T"), M.T), named(name, Theta), momenta, frozen_rates(momenta, E.rate(p)),
                 named(partial(name, jet_labels(M, 0)), E.by(0, Theta)), dependent_partials(M, E, energy("T"), M.T, 1),
                 rates_of_f_by_u(M, E), partials(pick(jet_labels(M, 1), E.dependent), jet_labels(M, 0), f_by_q),
                 forces_along(M, E)});
}

extern const Formulation voronets;
const Formulation voronets{"voronets",
                           "Voronets' equations",
                           "",
                           "Voronets 1901",
                           Unknowns::coordinates,
                           first_order_only,
                           equations,
                           quantities,
                           1};

}  // namespace anholon::forms
