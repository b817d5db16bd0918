// The Mac-Millan equations in a noninertial frame [Q 13], for constraints of order 1:
//
//   D/Dt dT_/dq_nu' - dT_/dq_nu = Q_nu + (Q_nu)_t + (Q_nu)_c + sum_i m_i (v_i) . (d/dt d(v_i)/dq_nu' - d(v_i)/dq_nu)
//
// (v_i) is the relative velocity of point i with q_D' = f substituted, T_ = sum 1/2 m |(v)|^2; every force is Q_nu +
// sum_b Q_b df_b/dq_nu', (Q)_t = Qomega - d(V_O + V_omega)/dq the transport, (Q)_c = Gamma the Coriolis force. Beyond
// the paper: variable masses (frozen derivatives, QR among the forces) and bodies (their axes are points of the sum).
// Without nonholonomic constraints the sum vanishes; with an observer at rest it is the equation in an inertial frame.
#include "formulation/formulation.h"

namespace anholon::forms {

// Returns the sum over the points.
static Column bracket_of(const Mechanics& M, const Elimination& E) {
  Column bracket(E.free.u.size(), M.graph().zero());
  for (const WeightedPoint& point : M.points) {
    const Vector v = total_derivative(point.place);
    for (int i = 0; i < 3; ++i) {
      // The terms are computed one by one, as in chaplygin.cpp.
      const Column rate = E.rate(E.by_u(v[i])), by_q = E.I(E.by(0, v[i])), turned = rate - by_q;
      for (std::size_t a = 0; a < bracket.size(); ++a) {
        const Expr speed = point.weight * E.on(v[i]);
        bracket[a] += speed * turned[a];
      }
    }
  }
  return bracket;
}

static Equations equations(const Mechanics& M, const Elimination& E) {
  const Expr T_bar = E.on(M.T);
  const Column bracket = bracket_of(M, E);
  const Column first = E.rate(E.by_u(T_bar)), second = E.I(E.by(0, T_bar));
  return {first - second, E.contract(forces(M)) + bracket};
}

static Quantities quantities(const Mechanics& M, const Elimination& E) {
  const Label bar = energy("T", 0, Over::bar), Q_bar = energy("Q", 0, Over::bar);
  const Expr T_bar = E.on(M.T);
  const Column p = E.by_u(T_bar);
  const Quantities momenta = named(partial(bar, free_labels(M, E)), p);
  Column v;
  for (const WeightedPoint& point : M.points)
    for (int i = 0; i < 3; ++i) v.push_back(total_derivative(point.place[i]));
  Labels brackets;
  for (const std::string& u : E.free.names)
    brackets.push_back(indexed({"bracket", "\\mathrm{bracket}", "<mi>bracket</mi>"}, u, {name_of(*M.model, u)}));
  Quantities list = listed({named(bar, T_bar), momenta, frozen_rates(momenta, E.rate(p)),
                            named(partial(bar, pick(jet_labels(M, 0), E.independent)), E.I(E.by(0, T_bar))),
                            named(point_labels(M, {"(v)", "(v)", "<mo>(</mo><mi>v</mi><mo>)</mo>"}), E.on(v)),
                            named(brackets, bracket_of(M, E)), along(M, E, Q_bar, M.Q + M.QD)});
  if (!M.model->masses.empty()) list = listed({list, along(M, E, with_superscript("QbarR", Q_bar, letter("R")), M.QR)});
  return listed({list,
                 along(M, E, with_superscript("Qbar_t", Q_bar, letter("t")), M.Qomega + M.minus_dVO + M.minus_dVomega),
                 along(M, E, with_superscript("Qbar_c", Q_bar, letter("c")), M.Gamma)});
}

extern const Formulation mac_millan;
const Formulation mac_millan{"mac-millan",
                             "Mac-Millan equations in a noninertial frame",
                             "(13)",
                             kQiu,
                             Unknowns::coordinates,
                             first_order_only,
                             equations,
                             quantities,
                             1};

}  // namespace anholon::forms
