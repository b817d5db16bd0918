#include "run/watch.h"

#include <algorithm>

#include "run/evaluate.h"

namespace anholon {

namespace {

// A redundant constraint missed by more than this of the size of the state no longer follows from
// the others.
constexpr double kRedundantMiss = 1e-7;

// The power of all forces for the energy balance. Constraints that do no work on the motion (first
// order and homogeneous, holonomic without t) are left out: their power is zero, and its terms, which
// are large and cancel, would only add round-off to the balance.
Expr balance_power(const Scenario& s, const Power& p) {
  const Mechanics& m = *s.mechanics;
  Graph& g = m.graph();
  Expr total = p.noncons;
  for (std::size_t r : s.system.constraints) {
    if (m.order[r] == 1 && s.classes[r].homogeneous) continue;
    Expr rate = g.zero();
    if (m.order[r] == 0) rate = -partial(m.phi[r], g.time());
    else
      for (std::size_t a = 0; a < m.q.size(); ++a) rate += m.Phi[r][a] * m.qd[a];
    total += m.lambda[r] * put_masses(*s.model, rate);
  }
  return total;
}

}  // namespace

std::vector<Expr> watched_quadratures(const Scenario& s, const Power& p) {
  std::vector<Expr> es = {balance_power(s, p)};
  for (const VaryingMass& m : s.model->masses) es.push_back(m.value);
  return es;
}

template <Number W>
Watch<W>::Watch(const Scenario& s, const Power& power, const std::vector<W>& parameters)
    : s_(s), outputs_(s, expressions(power), parameters) {}

// N, then what the residual report needs: h, E, G, Phi, the redundant constraints.
template <Number W>
Column Watch<W>::expressions(const Power& power) const {
  const Model& model = *s_.model;
  const Mechanics& m = *s_.mechanics;
  Column es = put_masses(model, m.N);
  es.push_back(power.h);
  const Column inertia = newton_left_side(m);
  const Column force = put_masses(model, m.Q + m.QR + m.Qomega + m.minus_dVO + m.minus_dVomega + m.Gamma);
  es.insert(es.end(), inertia.begin(), inertia.end());
  es.insert(es.end(), force.begin(), force.end());
  for (std::size_t k : s_.system.constraints)
    for (Expr e : m.Phi[k]) es.push_back(put_masses(model, e));
  for (std::size_t k : s_.redundant) es.push_back(put_masses(model, m.phi[k]));
  return es;
}

template <Number W>
Outcome Watch<W>::see(const Expansion<W>& point, SimulationReport& report) {
  outputs_.evaluate(point);
  const std::size_t n = s_.system.coordinates;
  std::vector<W> inertia(n), force(n), reaction(n);
  Matrix<W> phi(s_.system.constraints.size(), n);
  for (std::size_t a = 0; a < n; ++a) {
    reaction[a] = outputs_[a];
    inertia[a] = outputs_[n + 1 + a];
    force[a] = outputs_[2 * n + 1 + a];
  }
  for (std::size_t i = 0; i < phi.data.size(); ++i) phi.data[i] = outputs_[3 * n + 1 + i];
  const NewtonResidual<W> c = certify(inertia, force, reaction, phi);
  report.newton = std::max(report.newton, to_double(c.newton));
  report.projected = std::max(report.projected, to_double(c.projected));
  report.constraints_kept = std::max(report.constraints_kept, to_double(point.constraint_residual()));
  // A constraint that was left out because it followed from the others must go on to do so.
  W size(1);
  for (std::size_t a = 0; a < n; ++a)
    for (int k = 0; k < 2; ++k)
      if (W v = abs(point.derivative(a, k)); v > size) size = v;
  Outcome outcome;
  for (std::size_t i = 0; i < s_.redundant.size(); ++i) {
    const double miss = to_double(W(abs(outputs_[3 * n + 1 + phi.data.size() + i]) / size));
    report.constraints_kept = std::max(report.constraints_kept, miss);
    if (miss > kRedundantMiss)
      outcome = {OutcomeKind::singular,
                 "the constraint '" + s_.model->constraints[s_.redundant[i]].name + "' no longer follows from the others",
                 "it was redundant at the start only: start elsewhere, or leave out one of the constraints"};
  }
  return outcome;
}

template <Number W>
W Watch<W>::energy(const Expansion<W>& point) {
  outputs_.evaluate(point);
  return outputs_[s_.system.coordinates];
}

template <Number W>
double Watch<W>::balance(const Expansion<W>& point, const W& work) {
  const W h = energy(point);
  W scale(1);
  for (const W& v : {h, h0_, work})
    if (abs(v) > scale) scale = abs(v);
  return to_double(W(abs(W(h - h0_ - work)) / scale));
}

template class Watch<long double>;
template class Watch<Quad>;
template class Watch<Multi>;

}  // namespace anholon
