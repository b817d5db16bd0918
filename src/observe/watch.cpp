#include "observe/watch.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <type_traits>

namespace anholon {

// The constraints that may take part in the motion, by their index in the model: all, if there are redundant ones,
// because other constraints may become independent during the motion.
static std::vector<std::size_t> watched_rows(const Scenario& s) {
  if (s.redundant.empty()) return s.system.constraints;
  std::vector<std::size_t> all(s.model->constraints.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

// The number of derivatives of a constraint, itself counted, that are hidden constraints: by the structure, or, for a
// redundant one, by its order.
static int hidden_derivatives(const Scenario& s, std::size_t r) {
  const auto row = std::find(s.system.constraints.begin(), s.system.constraints.end(), r);
  if (row == s.system.constraints.end()) return std::max(0, 2 - s.mechanics->order[r]);
  return s.structure.c[s.system.coordinates + static_cast<std::size_t>(row - s.system.constraints.begin())];
}

// The power of all forces for the energy balance. Constraints that do no work on the motion (first order and
// homogeneous, holonomic without t) are left out: their power is zero, and its large terms, which cancel, would only
// add round-off to the balance.
static Expr balance_power(Workspace& s, const Power& p) {
  const Mechanics& m = *s.mechanics;
  Graph& g = m.graph();
  Expr total = p.noncons;
  for (std::size_t r : watched_rows(s)) {
    if (s.model->constraints[r].by || (m.order[r] == 1 && s.classes[r].homogeneous)) continue;
    Expr rate = g.zero();
    if (m.order[r] == 0)
      rate = -by_time(m.phi[r]);
    else
      for (std::size_t a = 0; a < m.q.size(); ++a) rate += m.Phi[r][a] * m.qd[a];
    total += m.lambda[r] * put_masses(*s.model, rate);
  }
  return total;
}

std::vector<Expr> watched_quadratures(Workspace& s, const Power& p) {
  std::vector<Expr> es = {balance_power(s, p)};
  for (const VaryingMass& m : s.model->masses) es.push_back(m.value);
  return es;
}

std::vector<ConstraintReport> constraint_reports(const Scenario& s) {
  std::vector<ConstraintReport> list;
  for (std::size_t r : watched_rows(s))
    list.push_back({s.model->constraints[r].name,
                    std::vector<double>(static_cast<std::size_t>(std::max(1, hidden_derivatives(s, r))), 0.0)});
  return list;
}

bool declared_conserved(const Model& model, const Monitor& m) {
  return std::any_of(model.outputs.begin(), model.outputs.end(), [&](const OutputQuantity& o) {
    return o.conserved && (m.name == o.name || (o.values.size() == 3 && m.name.rfind(o.name + ".", 0) == 0));
  });
}

template <Number W>
void Track<W>::see(const W& value) {
  if (!any) first = least = greatest = value;
  any = true;
  last = value;
  if (value < least) least = value;
  if (value > greatest) greatest = value;
  size = std::max(size, W(abs(value)));
  if (W v = abs(W(value - first)); v > change || !is_finite(v)) change = v;
}

template <Number W>
void Track<W>::see(const W& value, const W& terms, const W& made_of, const W& moved) {
  see(value);
  size = std::max(size, terms);
  made = std::max(made, made_of);
  const W miss = value - first;
  if (W v = relative_miss(miss, size, [&] { return size_behind(miss, made_of, moved); }); v > missed || !is_finite(v))
    missed = v;
}

template <Number W>
void Track<W>::see_double(double value, double terms, double made_of) {
  see(W(value));
  size = std::max(size, W(terms));
  const double v = relative_miss(to_double(W(W(value) - first)), to_double(size), [&] { return made_of; });
  if (W(v) > missed || !std::isfinite(v)) missed = W(v);
}

// The round-off of sums of numbers. Rows of motions in double are computed in doubles.
template <Number W>
static W round_off() {
  const W unit = std::is_same_v<W, long double> ? W(unit_roundoff<double>()) : unit_roundoff<W>();
  return unit * W(kRoundoffsOfSum);
}

template <Number W>
double Track<W>::relative_change() const {
  // Far above the error that integration leaves, relative to the terms and to the numbers that they are made of.
  constexpr double kNoise = 1e-6;
  if (missed > W(kNoise) && is_finite(made) && change <= W(kNoise) * made) return to_double(W(change / made));
  if (missed > W(0) || change == W(0)) return to_double(missed);
  // A number that is zero up to round-off has no size to which a change could be relative.
  if (is_finite(made) && size <= round_off<W>() * made) return 0;
  return to_double(W(change / size));
}

template <Number W>
Watch<W>::Watch(Workspace& s, const Power& power, const std::vector<Conserved>& conserved,
                const std::vector<W>& parameters)
    : s_(s), rows_(watched_rows(s)), outputs_(s, expressions(power, conserved), parameters), redundant_(s, parameters) {
}

// The expressions: N, then what the residual report needs (h, E, G, Phi), then the terms of what is watched.
template <Number W>
Column Watch<W>::expressions(const Power& power, const std::vector<Conserved>& conserved) {
  const Model& model = *s_.model;
  const Mechanics& m = *s_.mechanics;
  Column es = put_masses(model, m.N);
  es.push_back(power.h);
  const Column inertia = newton_left_side(m);
  const Column force = put_masses(model, forces(m));
  es.insert(es.end(), inertia.begin(), inertia.end());
  es.insert(es.end(), force.begin(), force.end());
  for (std::size_t k : rows_)
    for (Expr e : m.Phi[k]) es.push_back(model.constraints[k].by ? m.graph().zero() : put_masses(model, e));
  first_open_ = es.size();
  for (std::size_t i = 0; i < rows_.size(); ++i)
    if (hidden_derivatives(s_, rows_[i]) == 0) {
      open_.push_back(i);
      es.push_back(put_masses(model, m.phi[rows_[i]]));
    }
  first_monitor_ = es.size();
  for (const Monitor& monitor : model.monitors) {
    es.push_back(monitor.value);
    terms_.push_back(1);
    constant_.push_back(declared_conserved(model, monitor));
  }
  for (const Conserved& c : conserved) {
    es.insert(es.end(), c.terms.begin(), c.terms.end());
    terms_.push_back(c.terms.size());
    constant_.push_back(true);
  }
  tracks_.resize(terms_.size());
  made_of_.resize(terms_.size(), 0);
  return es;
}

template <Number W>
Outcome Watch<W>::see(const Expansion<W>& point, SimulationReport& report) {
  see_moved(point);
  outputs_.evaluate(point);
  const std::size_t n = s_.system.coordinates;
  std::vector<W> inertia(n), force(n), reaction(n);
  const std::vector<std::size_t> rows = rows_at(point);
  Matrix<W> phi(rows.size(), n);
  for (std::size_t a = 0; a < n; ++a) {
    reaction[a] = outputs_[a];
    inertia[a] = outputs_[n + 1 + a];
    force[a] = outputs_[2 * n + 1 + a];
  }
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t a = 0; a < n; ++a) phi(i, a) = outputs_[(3 + rows[i]) * n + 1 + a];
  newton(certify(inertia, force, reaction, phi), report);
  turn_over(energy());
  constraints(point, rows, phi, report);
  track();
  ++times_;
  multipliers_ = redundant_.multipliers(point);
  return still_redundant(point, report);
}

template <Number W>
void Watch<W>::newton(const NewtonResidual<W>& c, SimulationReport& report) {
  forces_ = std::max(forces_, c.largest);
  const auto relative = [&](const W& miss) {
    return to_double(relative_miss(miss, forces_, [&] { return size_behind(miss, made_of_forces(), moved_forces_); }));
  };
  report.newton = std::max(report.newton, relative(c.newton));
  report.projected = std::max(report.projected, relative(c.projected));
}

template <Number W>
void Watch<W>::see_moved(const Expansion<W>& point) {
  moved_forces_ = W(0);
  moved_.assign(tracks_.size(), W(0));
  if (!outputs_.evaluate_moved(point, abs(W(point.time() - start_)))) return;
  moved_forces_ = made_of_forces();
  std::size_t at = first_monitor_;
  for (std::size_t i = 0; i < tracks_.size(); ++i)
    for (std::size_t k = 0; k < terms_[i]; ++k, ++at)
      if (constant_[i]) moved_[i] += outputs_.made_of(at);
}

// The size of what N, E and G are made of.
template <Number W>
W Watch<W>::made_of_forces() const {
  W most(0);
  for (std::size_t i = 0; i < 3 * s_.system.coordinates + 1; ++i)
    if (const W& v = outputs_.made_of(i); i != s_.system.coordinates && v > most) most = v;
  return most;
}

template <Number W>
Outcome Watch<W>::still_redundant(const Expansion<W>& point, SimulationReport& report) {
  std::vector<typename Redundant<W>::Miss> misses;
  Outcome o = redundant_.hold(point, !(point.time() != start_), misses);
  for (const auto& [constraint, miss] : misses) {
    double& worst = report.constraints_each[constraint].residuals[0];
    worst = std::max(worst, miss);
    report.constraints_kept = std::max(report.constraints_kept, miss);
  }
  return o;
}

// The constraints that take part at a point: their indices among the watched ones, in the order of their unknowns.
template <Number W>
std::vector<std::size_t> Watch<W>::rows_at(const Expansion<W>& point) const {
  const std::vector<std::size_t>& kept = point.program().system->constraints;
  std::vector<std::size_t> rows;
  if (kept.size() == rows_.size()) {
    rows.resize(kept.size());
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    return rows;
  }
  for (std::size_t r : kept)
    rows.push_back(static_cast<std::size_t>(std::find(rows_.begin(), rows_.end(), r) - rows_.begin()));
  return rows;
}

// Computes C3, and each constraint that takes part with its derivatives. `rows`: their indices among the watched ones.
template <Number W>
void Watch<W>::constraints(const Expansion<W>& point, const std::vector<std::size_t>& rows, const Matrix<W>& phi,
                           SimulationReport& report) const {
  const std::size_t n = s_.system.coordinates;
  report.constraints_kept = std::max(report.constraints_kept, to_double(point.constraint_residual()));
  const auto worse = [&](std::size_t i, int k, double residual) {
    std::vector<double>& residuals = report.constraints_each[rows[i]].residuals;
    if (static_cast<std::size_t>(k) >= residuals.size()) return;
    double& worst = residuals[static_cast<std::size_t>(k)];
    worst = std::max(worst, residual);
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const int hidden = point.program().c[n + i];
    for (int k = 0; k < hidden; ++k) worse(i, k, to_double(point.hidden_residual(n + i, k)));
    const auto open = std::find(open_.begin(), open_.end(), rows[i]);
    if (hidden > 0 || open == open_.end()) continue;
    const std::size_t o = static_cast<std::size_t>(open - open_.begin());
    W terms(0);
    for (std::size_t a = 0; a < n; ++a)
      terms += abs(W(phi(i, a) * point.derivative(a, s_.mechanics->order[rows_[rows[i]]])));
    const double residual = to_double(relative_miss(outputs_[first_open_ + o], terms, [&] {
      return std::max(outputs_.made_of(first_open_ + o), point.size_of_level(0, n + i));
    }));
    worse(i, 0, residual);
    report.constraints_kept = std::max(report.constraints_kept, residual);
  }
}

template <Number W>
void Watch<W>::save(SavedRun& to) const {
  std::vector<W> tracks;
  for (const Track<W>& t : tracks_)
    tracks.insert(tracks.end(),
                  {W(t.any ? 1 : 0), t.first, t.last, t.least, t.greatest, t.change, t.size, t.missed, t.made});
  to.set_numbers("tracks", tracks);
  to.set_numbers<W>("energy", {h0_, forces_, turned_over_});
  to.set_numbers<W>("from", from_);
  to.set_numbers<double>("times", {static_cast<double>(times_)});
}

constexpr std::size_t kNumbersOfTrack = 9;  // in a saved run

template <Number W>
void Watch<W>::resume(const SavedRun& from, const std::vector<W>& parameters) {
  outputs_.set_parameters(parameters);
  redundant_.set_parameters(parameters);
  const std::vector<W> tracks = from.numbers<W>("tracks", kNumbersOfTrack * tracks_.size()),
                       energy = from.numbers<W>("energy", 3);
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const W* t = &tracks[kNumbersOfTrack * i];
    tracks_[i] = {!(t[0] == W(0)), t[1], t[2], t[3], t[4], t[5], t[6], t[7], t[8]};
  }
  h0_ = energy[0];
  forces_ = energy[1];
  turned_over_ = energy[2];
  from_ = from.numbers<W>("from", s_.system.coordinates);
  if (from.has("times")) times_ = static_cast<std::size_t>(from.number<double>("times"));
}

template <Number W>
void Watch<W>::look(const Expansion<W>& point) {
  outputs_.evaluate(point);
  track(Which::constants);
}

template <Number W>
void Watch<W>::look_at_ranges(const Expansion<W>& point) {
  outputs_.evaluate(point);
  track(Which::ranges);
  ++times_;
}

template <Number W>
void Watch<W>::track(Which which) {
  std::size_t at = first_monitor_;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (which == (constant_[i] ? Which::ranges : Which::constants)) {
      at += terms_[i];
      continue;
    }
    W value(0), terms(0);
    for (std::size_t k = 0; k < terms_[i]; ++k, ++at) {
      value += outputs_[at];
      terms += outputs_.terms(at);
    }
    if (!constant_[i]) {
      tracks_[i].see(value);
      tracks_[i].made = std::max(tracks_[i].made, outputs_.made_of(at - 1));
      continue;
    }
    W made(0);
    for (std::size_t k = at - terms_[i]; k < at; ++k) made += outputs_.made_of(k);
    const W moved = i < moved_.size() && is_finite(moved_[i]) ? std::max(made, moved_[i]) : made;
    made_of_[i] = to_double(moved);
    tracks_[i].see(value, terms, made, moved);
  }
}

template <Number W>
void Watch<W>::start(const Expansion<W>& point) {
  outputs_.evaluate(point);
  h0_ = energy();
  start_ = point.time();
  for (std::size_t a = 0; a < s_.system.coordinates; ++a) from_.push_back(point.derivative(a, 0));
  track();
}

template <Number W>
void Watch<W>::leave(const Expansion<W>& point) {
  outputs_.evaluate(point);
  before_ = energy();
  track();
}

template <Number W>
void Watch<W>::enter(const Expansion<W>& point, const std::vector<W>& parameters) {
  outputs_.set_parameters(parameters);
  redundant_.set_parameters(parameters);
  outputs_.evaluate(point);
  h0_ += energy() - before_;
  track(Which::ranges);
}

template <Number W>
void Watch<W>::end(const Expansion<W>& point, const W& work, SimulationReport& report) {
  outputs_.evaluate(point);
  const W h = energy();
  // Forces in balance turn no energy over. Then the measure is the work that each does on its way, whatever its sign.
  constexpr double kNone = 1e-8;  // half the digits of a double
  const std::size_t n = s_.system.coordinates;
  W ways(0), made_of = outputs_.made_of(n);
  for (std::size_t a = 0; a < n; ++a) {
    ways += outputs_.terms(2 * n + 1 + a) * abs(W(point.derivative(a, 0) - from_[a]));
    made_of += outputs_.made_of(2 * n + 1 + a) * abs(point.derivative(a, 0));
  }
  for (const W& v : {h, h0_, work}) turn_over(v);
  if (turned_over_ < ways * W(kNone)) turned_over_ = ways;
  report.turned_over = to_double(turned_over_);
  report.power = to_double(relative_miss(W(h - h0_ - work), turned_over_, [&] { return made_of; }));
  track();
}

template struct Track<long double>;
template struct Track<Quad>;
template struct Track<Multi>;
template class Watch<long double>;
template class Watch<Quad>;
template class Watch<Multi>;

}  // namespace anholon
