#include "run/watch.h"

#include <algorithm>

#include "run/evaluate.h"

namespace anholon {

// The power of all forces for the energy balance. Constraints that do no work on the motion (first
// order and homogeneous, holonomic without t) are left out: their power is zero, and its terms, which
// are large and cancel, would only add round-off to the balance.
static Expr balance_power(const Scenario& s, const Power& p) {
  const Mechanics& m = *s.mechanics;
  Graph& g = m.graph();
  Expr total = p.noncons;
  for (std::size_t r : s.system.constraints) {
    if (s.model->constraints[r].by || (m.order[r] == 1 && s.classes[r].homogeneous)) continue;
    Expr rate = g.zero();
    if (m.order[r] == 0) rate = -partial(m.phi[r], g.time());
    else
      for (std::size_t a = 0; a < m.q.size(); ++a) rate += m.Phi[r][a] * m.qd[a];
    total += m.lambda[r] * put_masses(*s.model, rate);
  }
  return total;
}

std::vector<Expr> watched_quadratures(const Scenario& s, const Power& p) {
  std::vector<Expr> es = {balance_power(s, p)};
  for (const VaryingMass& m : s.model->masses) es.push_back(m.value);
  return es;
}

std::vector<ConstraintReport> constraint_reports(const Scenario& s) {
  std::vector<ConstraintReport> list;
  for (std::size_t i = s.system.coordinates; i < s.system.mechanical(); ++i)
    list.push_back({s.system.equation_names[i], std::vector<double>(static_cast<std::size_t>(std::max(1, s.structure.c[i])), 0.0)});
  return list;
}

int orders_needed(const Scenario& s, std::span<const Expr> es) {
  int beyond = 0;
  for (NodeId id : symbols(es))
    if (const auto j = s.system.variable(id))
      beyond = std::max(beyond, static_cast<int>(s.model->graph->node(id).order) - s.structure.d[*j]);
  return beyond;
}

template <Number W>
void Track<W>::see(const W& value, const W& terms) {
  if (!any) first = least = greatest = value;
  any = true;
  last = value;
  if (value < least) least = value;
  if (value > greatest) greatest = value;
  if (terms > size) size = terms;
  if (W v = abs(W(value - first)); v > change || !is_finite(v)) change = v;
}

template <Number W>
Watch<W>::Watch(const Scenario& s, const Power& power, const std::vector<Conserved>& conserved, const std::vector<W>& parameters)
    : s_(s), outputs_(s, expressions(power, conserved), parameters), redundant_(s, parameters) {}

// N, then what the residual report needs: h, E, G, Phi; the terms of what is watched.
template <Number W>
Column Watch<W>::expressions(const Power& power, const std::vector<Conserved>& conserved) {
  const Model& model = *s_.model;
  const Mechanics& m = *s_.mechanics;
  Column es = put_masses(model, m.N);
  es.push_back(power.h);
  const Column inertia = newton_left_side(m);
  const Column force = put_masses(model, m.Q + m.QR + m.Qomega + m.minus_dVO + m.minus_dVomega + m.Gamma);
  es.insert(es.end(), inertia.begin(), inertia.end());
  es.insert(es.end(), force.begin(), force.end());
  for (std::size_t k : s_.system.constraints)
    for (Expr e : m.Phi[k]) es.push_back(model.constraints[k].by ? m.graph().zero() : put_masses(model, e));
  first_open_ = es.size();
  for (std::size_t i = 0; i < s_.system.constraints.size(); ++i)
    if (s_.structure.c[s_.system.coordinates + i] == 0) {
      open_.push_back(i);
      es.push_back(put_masses(model, m.phi[s_.system.constraints[i]]));
    }
  first_monitor_ = es.size();
  for (const Monitor& monitor : model.monitors) {
    es.push_back(monitor.value);
    terms_.push_back(1);
  }
  for (const Conserved& c : conserved) {
    es.insert(es.end(), c.terms.begin(), c.terms.end());
    terms_.push_back(c.terms.size());
  }
  tracks_.resize(terms_.size());
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
  constraints(point, phi, report);
  track();
  multipliers_ = redundant_.multipliers(point);
  return still_redundant(point, report);
}

template <Number W>
Outcome Watch<W>::still_redundant(const Expansion<W>& point, SimulationReport& report) {
  double missed = 0;
  Outcome o = redundant_.hold(point, !(point.time() != start_), missed);
  report.constraints_kept = std::max(report.constraints_kept, missed);
  return o;
}

// C3, and each constraint with its derivatives by itself.
template <Number W>
void Watch<W>::constraints(const Expansion<W>& point, const Matrix<W>& phi, SimulationReport& report) const {
  const std::size_t n = s_.system.coordinates;
  report.constraints_kept = std::max(report.constraints_kept, to_double(point.constraint_residual()));
  const auto worse = [&](std::size_t i, int k, double residual) {
    double& worst = report.constraints_each[i].residuals[static_cast<std::size_t>(k)];
    worst = std::max(worst, residual);
  };
  for (std::size_t i = 0; i < s_.system.constraints.size(); ++i)
    for (int k = 0; k < s_.structure.c[n + i]; ++k) worse(i, k, to_double(point.hidden_residual(n + i, k)));
  for (std::size_t o = 0; o < open_.size(); ++o) {
    const std::size_t i = open_[o];
    W scale(1);
    for (std::size_t a = 0; a < n; ++a)
      scale += abs(W(phi(i, a) * point.derivative(a, s_.mechanics->order[s_.system.constraints[i]])));
    const double residual = to_double(W(abs(outputs_[first_open_ + o]) / scale));
    worse(i, 0, residual);
    report.constraints_kept = std::max(report.constraints_kept, residual);
  }
}

template <Number W>
void Watch<W>::save(SavedRun& to) const {
  std::vector<W> tracks;
  for (const Track<W>& t : tracks_) tracks.insert(tracks.end(), {W(t.any ? 1 : 0), t.first, t.last, t.least, t.greatest, t.change, t.size});
  to.set_numbers("tracks", tracks);
  to.set_numbers<W>("energy", {h0_});
}

template <Number W>
void Watch<W>::resume(const SavedRun& from) {
  const std::vector<W> tracks = from.numbers<W>("tracks", 7 * tracks_.size());
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const W* t = &tracks[7 * i];
    tracks_[i] = {!(t[0] == W(0)), t[1], t[2], t[3], t[4], t[5], t[6]};
  }
  h0_ = from.number<W>("energy");
}

template <Number W>
void Watch<W>::track() {
  std::size_t at = first_monitor_;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    W value(0), terms(0);
    for (std::size_t k = 0; k < terms_[i]; ++k, ++at) {
      value += outputs_[at];
      terms += abs(outputs_[at]);
    }
    tracks_[i].see(value, terms);
  }
}

template <Number W>
void Watch<W>::start(const Expansion<W>& point) {
  outputs_.evaluate(point);
  h0_ = outputs_[s_.system.coordinates];
  start_ = point.time();
  track();
}

template <Number W>
void Watch<W>::leave(const Expansion<W>& point) {
  outputs_.evaluate(point);
  before_ = outputs_[s_.system.coordinates];
  track();
}

template <Number W>
void Watch<W>::enter(const Expansion<W>& point, const std::vector<W>& parameters) {
  outputs_.set_parameters(parameters);
  redundant_.set_parameters(parameters);
  outputs_.evaluate(point);
  h0_ += outputs_[s_.system.coordinates] - before_;
}

template <Number W>
void Watch<W>::end(const Expansion<W>& point, const W& work, SimulationReport& report) {
  outputs_.evaluate(point);
  const W h = outputs_[s_.system.coordinates];
  W scale(1);
  for (const W& v : {h, h0_, work})
    if (abs(v) > scale) scale = abs(v);
  report.power = to_double(W(abs(W(h - h0_ - work)) / scale));
  track();
}

template struct Track<long double>;
template struct Track<Quad>;
template struct Track<Multi>;
template class Watch<long double>;
template class Watch<Quad>;
template class Watch<Multi>;

}  // namespace anholon
