#include "contact/slow_slips.h"

#include <cmath>

#include "contact/law/slip_directions.h"

namespace anholon {

namespace {

// The rate at which friction turns a slip with two components into its direction: mu N over the mass against which it
// acts, divided by the slip velocity v.
long double rate_of_direction(const ContactProblem& p, const ContactModes& modes, const ContactSolution& f,
                              std::size_t c, long double v) {
  long double most = 0;
  ContactProblem pushed = p;
  for (const std::vector<long double>& t : p.contacts[c].tangential) {
    for (std::size_t i = 0; i < p.b.size(); ++i) pushed.b[i] = p.b[i] - t[i];
    const auto g = of_modes(pushed, modes);
    if (!g) return 0;
    most = std::max(most, std::abs(dot(t, g->x) - dot(t, f.x)));
  }
  return p.contacts[c].friction * f.normal[c] * most / v;
}

}  // namespace

std::optional<long double> stiff_for(const TouchingBodies& bodies, long double left) {
  // Taylor's steps are about 6 divided by this rate. A stretch is given up where the slip has become kLonger times as
  // fast.
  constexpr long double kStiff = 3000, kLonger = 30;
  const ContactProblem& p = bodies.dynamics.accelerations();
  const auto f = of_modes(p, bodies.modes);
  if (!f) return std::nullopt;
  long double stiffest = 0, time = 0;
  for (std::size_t c = 0; c < bodies.modes.size(); ++c) {
    const ContactRows& rows = p.contacts[c];
    if (bodies.modes[c].begins) return std::nullopt;
    if (bodies.modes[c].touch != Touch::slips || !rows.rough || rows.tangential.size() < 2) continue;
    const auto& slip = bodies.dynamics.place(c).slip;
    const long double v = std::hypot(slip[0], slip[1]);
    if (!(v > 0)) continue;
    const auto a = slip_rate(rows, f->x);
    const long double to_change = std::min(left, v / std::max(std::hypot(a[0], a[1]), v / left));
    const long double stiff = rate_of_direction(p, bodies.modes, *f, c, v) * to_change;
    if (!(stiff > stiffest)) continue;
    stiffest = stiff, time = std::min(left, kLonger * to_change);
  }
  if (stiffest < kStiff) return std::nullopt;
  return time;
}

std::vector<Rational> times_of_stretch(const Rational& from, const Rational& to) {
  constexpr int kTimes = 64;
  constexpr double kSpan = 1000;  // the ratio of the last distance to the first
  const double span = Rational(to - from).get_d();
  std::vector<Rational> times;
  for (int k = 1; k < kTimes; ++k) {
    const Rational t(from.get_d() + span * (std::pow(kSpan, double(k) / kTimes) - 1) / (kSpan - 1));
    if (t > (times.empty() ? from : times.back()) && t < to) times.push_back(t);
  }
  times.push_back(to);
  return times;
}

void StretchRows::columns(const std::vector<RunColumn>& columns) {
  for (const RunColumn& c : columns) {
    const bool condition = !c.name.empty() && c.name[0] == kCondition;
    passed_.push_back(!condition);
    if (!condition) columns_.push_back(c);
  }
}

void StretchRows::row(const Row& row) {
  std::vector<double> values;
  std::size_t condition = 0;
  for (std::size_t k = 0; k < row.values.size(); ++k) {
    if (passed_[k])
      values.push_back(row.values[k]);
    else if (!(conditions_[condition++] * row.values[k] >= 0))
      held_ = false;
  }
  if (held_) rows_.push_back(std::move(values));
}

std::optional<double> StretchRows::held_until() const {
  if (rows_.empty()) return std::nullopt;
  return rows_.back()[0];
}

void StretchRows::pass_to(RowSink& sink) const {
  sink.columns(columns_);
  for (const std::vector<double>& values : rows_) sink.row({values, {}});
}

}  // namespace anholon
