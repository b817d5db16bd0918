// The Boltzmann-Hamel equations (theory: classics), for constraints of order 1, with n quasi-velocities u_k(q, q', t),
// nonlinear ones too, of which the last s are the constraints. q' = chi(q, u, t), beta = dchi/du, T* = T with q' = chi:
//
//   D/Dt dT*/du_a - sum_s dT*/dq_s beta_sa + sum_k dT*/du_k sum_s (d/dt du_k/dq_s' - du_k/dq_s) beta_sa = sum_s G_s beta_sa
//
// for the n - s free ones; k runs over all n, and the last s are set to zero only after that.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination& E) {
  const Column p = gradient(M.T, M.qd), p_u = p * E.quasi->chi_by_u;  // dT*/du_k = sum_s dT/dq_s' dchi_s/du_k
  Rows u_by_q, turned;                                                // du_k/dq_s;  d/dt du_k/dq_s' - du_k/dq_s
  for (Expr u : E.quasi->w) {
    u_by_q.push_back(gradient(u, M.q));
    turned.push_back(total_derivative(gradient(u, M.qd)) - u_by_q.back());
  }
  // The terms are computed one by one, as in chaplygin.cpp.
  const Column by_q = gradient(M.T, M.q), through_u = p_u * u_by_q,
               T_by_q = by_q - through_u;  // at fixed u: dchi/dq = -beta du/dq
  const Column momentum(p_u.begin(), p_u.begin() + static_cast<std::ptrdiff_t>(E.free.u.size()));
  const Column first = E.rate(momentum), second = E.contract(T_by_q), third = E.contract(p_u * turned);
  return {first - second + third, E.contract(forces(M))};
}

static Quantities quantities(const Mechanics& M, const Elimination& E) {
  const Label star = energy("T", 0, Over::star);
  const Labels q = jet_labels(M, 0), qd = jet_labels(M, 1);
  Labels u = free_labels(M, E);  // all n quasi-velocities
  for (std::size_t r : E.constraints) {
    const std::string& name = M.model->constraints[r].name;
    u.push_back(indexed(letter("phi"), name, {name_of(*M.model, name)}));
  }
  const Column p_u = gradient(M.T, M.qd) * E.quasi->chi_by_u;
  const Column momentum(p_u.begin(), p_u.begin() + static_cast<std::ptrdiff_t>(E.free.u.size()));
  const Quantities momenta = named(partial(star, u), E.on(p_u));
  Quantities list =
      listed({named(energy("T"), M.T), reduced(E, star, M.T), momenta, frozen_rates(momenta, E.rate(momentum))});
  Rows u_by_q;
  for (Expr e : E.quasi->w) u_by_q.push_back(gradient(e, M.q));
  list = listed({list, named(partial(star, q), E.on(gradient(M.T, M.q) - p_u * u_by_q))});
  for (std::size_t k = 0; k < E.quasi->w.size(); ++k) {
    const Column turned = E.on(total_derivative(gradient(E.quasi->w[k], M.qd)) - u_by_q[k]);
    for (std::size_t s = 0; s < turned.size(); ++s)
      if (!is_zero(turned[s])) list.push_back({rate(partial(u[k], qd[s])) - partial(u[k], q[s]), turned[s]});
  }
  return listed({list, forces_along(M, E)});
}

extern const Formulation boltzmann_hamel;
const Formulation boltzmann_hamel{"boltzmann-hamel",
                                  "Boltzmann–Hamel equations",
                                  "",
                                  "Boltzmann 1902, Hamel 1904",
                                  Unknowns::quasi_velocities,
                                  first_order_only,
                                  equations,
                                  quantities,
                                  1};

}  // namespace anholon::forms
