#include "integrate/states/runge_kutta.h"

#include <algorithm>
#include <cmath>

#include "base/assert.h"
#include "integrate/step_budget.h"

namespace anholon {

namespace {

namespace method = dormand_prince;

// Steps smaller than this many round-offs of the time are a collapse.
constexpr int kCollapsedRoundoffs = 16;
constexpr double kBlowUp = 1e100;
// After a refusal a step without a value of f is five times shorter; a step may be refused so often.
constexpr int kMostRefusals = 40;
// After so many steps in a row that a kink cut at their start, the motion stays at the kink.
constexpr int kMostShortKinks = 20;
// Taylor's steps have errors of about this part of the tolerance, so the tolerance means the same here.
constexpr double kOfTolerance = 0.1;
// PI controller (Hairer & Wanner, IV.2): exponents for an estimate of order 8, and the bounds of one change.
constexpr double kProportional = 0.7 / method::kOrder, kIntegral = 0.4 / method::kOrder, kSafety = 0.9, kLeast = 0.2,
                 kMost = 5;

// A coefficient that is not zero, in double.
struct Term {
  std::size_t stage;
  double factor;
};
using Row = std::vector<Term>;

Row row(const std::array<long double, method::kStages>& from) {
  Row r;
  for (std::size_t j = 0; j < from.size(); ++j)
    if (from[j] != 0) r.push_back({j, static_cast<double>(from[j])});
  return r;
}

struct Table {
  std::array<Row, method::kStages> a;
  Row b, e5, e3;
};

const Table& table() {
  static const Table made = [] {
    Table t;
    for (std::size_t i = 0; i < method::kStages; ++i) t.a[i] = row(method::a[i]);
    t.b = row(method::b);
    t.e5 = row(method::e5);
    std::array<long double, method::kStages> e3{};
    for (std::size_t i = 0; i < method::kStages; ++i) e3[i] = method::b[i] - method::b3[i];
    t.e3 = row(e3);
    return t;
  }();
  return made;
}

template <class Stages>
void weigh(const Row& row, const Stages& k, std::size_t count, std::vector<double>& out) {
  out.assign(count, 0.0);
  for (const Term& term : row) {
    const std::vector<double>& from = k[term.stage];
    for (std::size_t i = 0; i < count; ++i) out[i] += term.factor * from[i];
  }
}

void narrow(const std::vector<long double>& from, std::vector<double>& to) {
  to.resize(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) to[i] = static_cast<double>(from[i]);
}

// Adds x to s and keeps the round-off in `carry`.
void add(long double& s, long double& carry, double x) {
  const long double y = x + carry, sum = s + y;
  carry = std::abs(s) >= std::abs(y) ? (s - sum) + y : (y - sum) + s;
  s = sum;
}

}  // namespace

RungeKutta::RungeKutta(StateRate rate, const StepSettings& settings)
    : rate_(std::move(rate)), settings_(settings), tolerance_(kOfTolerance * std::exp(settings.log_tolerance)) {
  for (std::vector<double>& k : k_) k.resize(rate_.size() + rate_.integrands().size());
}

Outcome RungeKutta::start(const MotionPoint& from, long double end) {
  now_ = before_ = from;
  paces_.begin(from.t, steps_);
  stops_ = {rate_.program(), rate_.parameters(), known_quadratures(settings_), from.t, end};
  carry_.state.assign(from.state.size(), 0);
  carry_.integrals.assign(from.integrals.size(), 0);
  rate_.set_leading(from.leading);
  error_before_ = 1;
  if (Outcome o = first_rate(); !o.ok()) return o;
  before_ = now_;
  k_[0] = here_;
  h_ = first_step(end < from.t ? -1 : 1);
  return {};
}

// Evaluates f at now(), which is moved onto the constraints.
Outcome RungeKutta::first_rate() {
  narrow(now_.state, y_);
  if (Outcome o = rate_.evaluate(static_cast<double>(now_.t), y_, true); !o.ok()) return o;
  if (rate_.moved())
    for (std::size_t i = 0; i < y_.size(); ++i)
      if (const double moved = rate_.state()[i] - y_[i]; moved != 0) now_.state[i] += moved, carry_.state[i] = 0;
  now_.leading = rate_.leading();
  kinks_.sides = rate_.sides();
  kinks_.arguments = rate_.arguments();
  here_ = rate_.rate();
  here_.insert(here_.end(), rate_.integrands().begin(), rate_.integrands().end());
  worst_constraint_ = std::max(worst_constraint_, rate_.drift());
  return {};
}

// Estimates the first step from the sizes of x' and x'' (Hairer, Nørsett & Wanner 1993, II.4).
double RungeKutta::first_step(double direction) {
  narrow(now_.state, start_);
  scale_sizes(rate_, start_, sizes_);
  const auto weight = [&](std::size_t i) { return 1 / (tolerance_ * sizes_[rate_.scale()[i]]); };
  double d0 = 1, d1 = 0, d2 = 0;
  for (std::size_t i = 0; i < start_.size(); ++i)
    d0 = std::max(d0, std::abs(start_[i]) * weight(i)), d1 = std::max(d1, std::abs(here_[i]) * weight(i));
  const double h0 = d1 > 0 ? 0.01 * d0 / d1 : 1;
  y_ = start_;
  for (std::size_t i = 0; i < y_.size(); ++i) y_[i] += direction * h0 * here_[i];
  if (!rate_.evaluate(static_cast<double>(now_.t) + direction * h0, y_).ok()) return h0 * 1e-3;
  for (std::size_t i = 0; i < y_.size(); ++i) d2 = std::max(d2, std::abs(rate_.rate()[i] - here_[i]) * weight(i) / h0);
  const double largest = std::max(d1, d2);
  return std::min(100 * h0, largest > 0 ? std::pow(0.01 / largest, 1.0 / method::kOrder) : 1.0);
}

// Computes k_[1], … for a step of h. REQUIRES: k_[0] is known.
Outcome RungeKutta::stages(const MotionPoint& from, double h) {
  const std::size_t n = rate_.size();
  narrow(from.state, start_);
  for (std::size_t s = 1; s < method::kStages; ++s) {
    weigh(table().a[s], k_, n, y_);
    for (std::size_t i = 0; i < n; ++i) y_[i] = start_[i] + h * y_[i];
    if (Outcome o = rate_.evaluate(static_cast<double>(from.t + method::c[s] * h), y_); !o.ok()) return o;
    std::copy(rate_.rate().begin(), rate_.rate().end(), k_[s].begin());
    std::copy(rate_.integrands().begin(), rate_.integrands().end(), k_[s].begin() + static_cast<std::ptrdiff_t>(n));
  }
  return {};
}

// Computes the stages of a step from now(), and f at its end.
Outcome RungeKutta::whole(double h) {
  if (Outcome o = stages(now_, h); !o.ok()) return o;
  weigh(table().b, k_, rate_.size(), y_);
  for (std::size_t i = 0; i < y_.size(); ++i) y_[i] = start_[i] + h * y_[i];
  return rate_.evaluate(static_cast<double>(now_.t) + h, y_, true);
}

// True if f was evaluated beyond a kink.
bool RungeKutta::turned() const { return rate_.sides().size() == kinks_.sides.size() && rate_.sides() != kinks_.sides; }

// After a whole step of h that has gone beyond a kink, makes the step to just beyond the first one, with its stages. It
// is found by secants (Illinois) through whole steps that end on both sides of it.
Outcome RungeKutta::cut_at_kink(double& h) {
  constexpr int kPastKink = 32, kMostTries = 60;
  struct End {
    double h;
    std::vector<double> arguments;
    double weight = 1;
  };
  const double direction = h < 0 ? -1 : 1;
  const double past =
      0x1p-53 * kPastKink * std::max(std::abs(static_cast<double>(now_.t)), std::abs(h)) + tolerance_ * std::abs(h);
  End low{0, kinks_.arguments}, high{std::abs(h), rate_.arguments()};
  std::vector<int> ends = rate_.sides();
  bool at_high = true;
  for (int tries = 0; tries < kMostTries && high.h - low.h > past; ++tries) {
    // The first of the arguments that have turned, by linear interpolation.
    double root = high.h;
    for (std::size_t i = 0; i < ends.size(); ++i) {
      if (ends[i] == kinks_.sides[i]) continue;
      const double before = low.weight * rate_.beyond(i, low.arguments[i], kinks_.sides[i], ends[i]),
                   after = high.weight * rate_.beyond(i, high.arguments[i], kinks_.sides[i], ends[i]);
      root = std::min(root, before < 0 && after > 0 ? low.h + (high.h - low.h) * before / (before - after)
                            : before < 0            ? high.h
                                                    : low.h);
    }
    const double there = std::clamp(root + past / 2, low.h + past / 4, high.h - past / 4);
    if (Outcome o = whole(direction * there); !o.ok()) return o;
    const bool beyond = turned();
    // The step is too long even without the kink, and is refused like any other.
    if (!beyond && error(direction * there) > 1) {
      h = direction * there;
      return {};
    }
    End& moved = beyond ? high : low;
    End& other = beyond ? low : high;
    other.weight = tries > 0 && at_high == beyond ? other.weight / 2 : 1;
    moved = {there, rate_.arguments()};
    at_high = beyond;
    if (beyond) ends = rate_.sides();
  }
  h = direction * high.h;
  kinks_.short_steps = high.h > 4 * past ? 0 : kinks_.short_steps + 1;
  return at_high ? Outcome{} : whole(h);
}

// Returns the largest error of all levels and integrals, in units of the tolerance.
double RungeKutta::error(double h) {
  const std::size_t n = rate_.size(), all = k_[0].size();
  weigh(table().e5, k_, all, e5_);
  weigh(table().e3, k_, all, e3_);
  // The largest estimates of each level, and of each integral.
  most_.assign(sizes_.size() + all - n, {0.0, 0.0});
  for (std::size_t i = 0; i < all; ++i) {
    auto& [five, three] = most_[i < n ? rate_.scale()[i] : sizes_.size() + i - n];
    if (!std::isfinite(e5_[i]) || !std::isfinite(e3_[i])) return std::numeric_limits<double>::infinity();
    five = std::max(five, std::abs(e5_[i]));
    three = std::max(three, std::abs(e3_[i]));
  }
  double worst = 0;
  for (std::size_t k = 0; k < most_.size(); ++k) {
    const auto [e5, e3] = most_[k];
    const double five = e5 * e5, three = e3 * e3;
    if (!(five > 0)) continue;
    // An error of an integral does not affect later steps, so the tolerance itself is enough for integrals.
    const double allowed = k < sizes_.size()
                               ? tolerance_ * sizes_[k]
                               : tolerance_ / kOfTolerance *
                                     std::max(1.0, static_cast<double>(std::abs(now_.integrals[k - sizes_.size()])));
    worst = std::max(worst, std::abs(h) * five / std::sqrt(five + 0.01 * three) / allowed);
  }
  return worst;
}

void RungeKutta::advance(MotionPoint& to, RoundOffs& carry, double h) {
  const std::size_t n = rate_.size();
  weigh(table().b, k_, k_[0].size(), change_);
  for (std::size_t i = 0; i < n; ++i) add(to.state[i], carry.state[i], h * change_[i]);
}

Outcome RungeKutta::may_go_on(long double left) {
  if (Outcome o = may_step(settings_, steps_); !o.ok()) return o;
  return paces_.out_of_reach(settings_, steps_, now_.t, h_, static_cast<double>(left)) ? end_out_of_reach(settings_, h_)
                                                                                       : Outcome{};
}

// Goes on from before a kink that the time alone decides to a time a few round-offs ahead, behind it. Without a value
// there the motion stays before it, and the next step fails by itself.
void RungeKutta::pass(const TimeStops::Stop& kink) {
  const MotionPoint now = now_;
  const RoundOffs carry = carry_;
  const std::vector<double> here = here_;
  const Kinks kinks = kinks_;
  const double h = kink.behind - kink.before;
  for (std::size_t i = 0; i < now_.state.size(); ++i) add(now_.state[i], carry_.state[i], h * here_[i]);
  for (std::size_t i = 0; i < now_.integrals.size(); ++i)
    add(now_.integrals[i], carry_.integrals[i], h * here_[rate_.size() + i]);
  now_.t = kink.behind;
  if (first_rate().ok()) {
    passed_ = kink;
    return;
  }
  now_ = now, carry_ = carry, here_ = here, kinks_ = kinks;
  rate_.set_leading(now_.leading);
}

Outcome RungeKutta::step(long double end) {
  if (Outcome o = may_go_on(end - now_.t); !o.ok()) return o;
  const auto stop = stops_.next(now_.t, end);
  const bool ahead = stop && (end > now_.t ? stop->before > now_.t : stop->before < now_.t);
  if (stop) end = ahead ? stop->before : stop->behind;
  const long double left = end - now_.t;
  const double floor = 0x1p-53 * kCollapsedRoundoffs * static_cast<double>(std::abs(now_.t));
  k_[0] = here_;
  narrow(now_.state, start_);
  scale_sizes(rate_, start_, sizes_);
  Outcome trouble;
  for (int again = 0;; ++again) {
    if (again > 0) ++refused_;
    const bool last = !(h_ < std::abs(left));
    // The time at the end of the step is a double.
    long double reached = last ? end : static_cast<long double>(static_cast<double>(now_.t + (left > 0 ? h_ : -h_)));
    double h = static_cast<double>(reached - now_.t);
    if ((!(std::abs(h) > floor) && !last) || again > kMostRefusals) {
      if (!trouble.ok()) return trouble;
      return {OutcomeKind::step_collapse, "the step size fell below what the time can resolve",
              "the motion approaches a singularity: stop before it, or look at the last good state"};
    }
    trouble = kinks_.sides.empty() ? stages(now_, h) : whole(h);
    bool cut = false;
    if (trouble.ok() && !kinks_.sides.empty() && turned()) {
      trouble = cut_at_kink(h);
      cut = true;
      reached = static_cast<long double>(static_cast<double>(now_.t + h));
      if (kinks_.short_steps > kMostShortKinks)
        return {OutcomeKind::step_collapse, "the motion stays at a kink", "put a smooth function in its place"};
    } else {
      kinks_.short_steps = 0;
    }
    if (!trouble.ok()) {
      if (rate_.guarded()) return trouble;  // shorter steps would end where round-off hides the side of the guard
      h_ = kLeast * std::abs(h);
      continue;
    }
    const double e = error(h);
    if (!(e <= 1)) {
      h_ = std::abs(h) * std::max(kLeast, std::isfinite(e) ? kSafety * std::pow(e, -1.0 / method::kOrder) : 0.0);
      continue;
    }
    MotionPoint next = now_;
    RoundOffs carry = carry_;
    advance(next, carry, h);
    for (long double x : next.state)
      if (!std::isfinite(x) || std::abs(x) > kBlowUp)
        return {OutcomeKind::blow_up, "the motion grows without bound",
                "look at the last good state: a velocity or position diverges"};
    for (std::size_t i = 0; i < next.integrals.size(); ++i)
      add(next.integrals[i], carry.integrals[i], h * change_[rate_.size() + i]);
    next.t = reached;
    std::swap(before_, now_);
    std::swap(now_, next);
    std::swap(carry_, carry);
    trouble = first_rate();
    if (!trouble.ok()) {  // the step was too long
      std::swap(now_, before_);
      std::swap(before_, next);
      std::swap(carry_, carry);
      here_ = k_[0];
      rate_.set_leading(now_.leading);
      if (rate_.guarded()) return trouble;
      h_ = kLeast * std::abs(h);
      continue;
    }
    passed_.reset();
    if (ahead && now_.t == stop->before && stop->behind != stop->before) pass(*stop);
    ++steps_;
    const double grown = e > 0 ? kSafety * std::pow(e, -kProportional) * std::pow(error_before_, kIntegral) : kMost;
    // A step that the end or a kink has cut short does not limit the next step. After a refusal a step does not grow.
    const double next_h = std::abs(h) * std::clamp(grown, kLeast, again > 0 ? 1.0 : kMost);
    h_ = last || cut ? std::max(h_, next_h) : next_h;
    error_before_ = std::max(e, 1e-4);
    return {};
  }
}

Outcome RungeKutta::at(long double t, MotionPoint& point) {
  if (t == now_.t || t == before_.t) {
    point = t == now_.t ? now_ : before_;
    return {};
  }
  if (passed_ && passed_->within(t)) {
    point = now_;
    point.t = t;
    const long double back = t - now_.t;
    for (std::size_t i = 0; i < point.state.size(); ++i) point.state[i] += back * here_[i];
    return {};
  }
  const double h = static_cast<double>(t - before_.t);
  if (Outcome o = stages(before_, h); !o.ok()) return o;
  RoundOffs carry{std::vector<long double>(before_.state.size(), 0), {}};
  point = before_;
  point.t = t;
  advance(point, carry, h);
  for (std::size_t i = 0; i < point.integrals.size(); ++i) point.integrals[i] += h * change_[rate_.size() + i];
  return {};
}

}  // namespace anholon
