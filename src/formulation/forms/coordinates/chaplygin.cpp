// Chaplygin's equations, generalized to constraints of order m [L 3.13]. With T~ = T^(m-1) where q_D^(m) = f is
// substituted before the partial derivatives are taken [L 3.12]:
//
//   m D/Dt dT~/dq_nu^(m) - dT~/dq_nu^(m-1) - sum_b dT^(m-1)/dq_b^(m) (m d/dt df_b/dq_nu^(m) - df_b/dq_nu^(m-1))
//     - sum_b dT^(m-1)/dq_b^(m-1) df_b/dq_nu^(m)  =  G_nu + sum_b G_b df_b/dq_nu^(m)
//
// In the sums T is not reduced. f may depend on everything up to q^(m-1), dependent coordinates included.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination& E) {
  const Rational m(E.m);
  const Expr T_before = T(M, E.m - 1), T_tilde = E.on(T_before);
  const Column p = E.on(E.D(gradient(T_before, jets(*M.model, E.m))));      // dT^(m-1)/dq_b^(m)
  const Column r = E.on(E.D(gradient(T_before, jets(*M.model, E.m - 1))));  // dT^(m-1)/dq_b^(m-1)
  // The terms are computed one by one: compilers evaluate the operands of a sum in different orders, and the order of
  // creation of nodes determines the order of sums.
  const auto f_by_u = E.f_by_u();
  const auto turned = m * E.rate(f_by_u), f_by = E.f_by(E.m - 1);
  const Column first = m * E.rate(E.by_u(T_tilde)), second = E.I(E.by(E.m - 1, T_tilde)), third = p * (turned - f_by),
               fourth = r * f_by_u;
  return {first - second - third - fourth, E.contract(forces(M))};
}

static Quantities quantities(const Mechanics& M, const Elimination& E) {
  const Expr T_before = T(M, E.m - 1), T_tilde = E.on(T_before);
  const Label before = energy("T", E.m - 1), tilde = energy("T", E.m - 1, Over::tilde);
  const Column p = E.by_u(T_tilde);
  const Quantities momenta = named(partial(tilde, free_labels(M, E)), p);
  return listed({named(before, T_before), named(tilde, T_tilde), momenta, frozen_rates(momenta, E.rate(p)),
                 named(partial(tilde, pick(jet_labels(M, E.m - 1), E.independent)), E.I(E.by(E.m - 1, T_tilde))),
                 dependent_partials(M, E, before, T_before, E.m), dependent_partials(M, E, before, T_before, E.m - 1),
                 rates_of_f_by_u(M, E), f_by_lower(M, E), forces_along(M, E)});
}

extern const Formulation chaplygin;
const Formulation chaplygin{"chaplygin",
                            "Chaplygin's equations, generalized to order m",
                            "(3.13)",
                            kLuoZhao,
                            Unknowns::coordinates,
                            no_obstacle,
                            equations,
                            quantities,
                            kHighestM};

}  // namespace anholon::forms
