#include "integrate/kernel_expansion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "integrate/series/hidden_points.h"
#include "integrate/series/kinks.h"
#include "integrate/sigma_schedule.h"
#include "integrate/step_control.h"

namespace anholon {

// If the tolerance asks for the last digits, pivots have to be so healthy that the elimination loses no digits; below
// that, the reference makes the expansion and refines its solutions in wider numbers.
static double trusted_health(const KernelPlan& plan, double log_tolerance) {
  constexpr double kLosesNone = 0.25;
  return asks_for_last_digits(log_tolerance) && !plan.map() ? kLosesNone : plan.least_health();
}

KernelExpansion::KernelExpansion(std::shared_ptr<Kernel> kernel, int lane, const Program& motion, int order,
                                 double log_tolerance)
    : kernel_(std::move(kernel)), lane_(lane), program_(&motion), order_(order),
      least_health_(trusted_health(kernel_->plan(), log_tolerance)) {
  kernel_->set_shrink(step_shrink(log_tolerance, order));
  // A kernel with unknowns of its own has roots of its own; J keeps their arguments from zero, so they need no look.
  if (!mapped()) deciding_ = kernel_->plan().plan().deciding;
}

bool KernelExpansion::without_positions() const {
  return std::all_of(program_->c.begin(), program_->c.end(), [](int c) { return c < 2; });
}

void KernelExpansion::load(MotionTrack<double>& track, const std::vector<W>& guess) {
  MotionState<double>& m = track.now;
  if (!holds_) {
    for (std::size_t i = 0; i < m.carry.size(); ++i) m.state[i] += m.carry[i];
    m.carry.clear();
    if (!mapped()) {
      kernel_->place(lane_, m.state, guess);
    } else {
      if (m.own.empty()) {
        kernel_->reader(lane_).own(m.t, m.state, m.own);
        m.own_leading.clear();
      }
      kernel_->place(lane_, m.own, m.own_leading);
      // The state is kept because the map may have no value here.
      track.begun().at.motion.state = m.state;
    }
    holds_ = true;
  }
  kernel_->set_time(lane_, static_cast<double>(m.t));
}

bool KernelExpansion::serves(StepRecord<double>& record, bool measure, bool follows) {
  const Pivots pivots = kernel_->pivots(lane_);
  suspected_ = follows && may_have_vanished(pivots_, pivots);
  pivots_ = pivots;
  if (!(pivots.health > least_health_) || (measure && pivots.health < record.least_health * kPivotDropToRecheck) ||
      !kernel_->reaches(lane_)) {
    record.least_health = std::min(record.least_health, pivots.health);
    return false;
  }
  if (const W drift(kernel_->drift(lane_)); record.worst_constraint < drift) record.worst_constraint = drift;
  return true;
}

bool KernelExpansion::serves_at_once(StepRecord<double>& record, bool measure) {
  const Pivots pivots = kernel_->pivots(lane_);
  if (may_have_vanished(pivots_, pivots) || !(pivots.health > least_health_) ||
      (measure && pivots.health < record.least_health * kPivotDropToRecheck) || !kernel_->reaches(lane_))
    return false;
  suspected_ = false;
  pivots_ = pivots;
  const double drift = kernel_->drift(lane_);
  if (record.worst_constraint < W(drift)) record.worst_constraint = W(drift);
  return true;
}

bool KernelExpansion::hides_nothing_over(double h) const {
  const Plan& plan = kernel_->plan().plan();
  if (plan.hiding.empty()) return true;
  kernel_->show_last();
  return std::all_of(plan.hiding.begin(), plan.hiding.end(), [&](const Plan::HidingSeries& slot) {
    return hides_nothing(slot.function, kernel_->whole_series(slot.argument, lane_),
                         static_cast<std::size_t>(kernel_->lanes()), order_ - 1, h);
  });
}

std::vector<double> KernelExpansion::coefficients(const Place& place) const {
  std::vector<double> c(static_cast<std::size_t>(order_));
  for (int k = 0; k < order_; ++k) c[static_cast<std::size_t>(k)] = kernel_->series(place, k, lane_);
  return c;
}

void KernelExpansion::show_deciding(Expansion<double>& series) const {
  for (const Plan::Deciding& d : deciding_)
    for (int k = 0; k < order_; ++k) series.adopt_coefficient(d.slot, k, kernel_->series(d.place, k, lane_));
}

void KernelExpansion::look_for_turns(double horizon) {
  using K = Plan::Deciding::Kind;
  may_turn_ = std::any_of(deciding_.begin(), deciding_.end(), [&](const Plan::Deciding& d) {
    std::vector<double> c = coefficients(d.place);
    if (d.kind == K::radicand) return !stays_positive(c.data(), order_ - 1, horizon);
    if (d.kind == K::sign) return !keeps_sign(c.data(), order_ - 1, horizon);
    const std::vector<double>& knots = kernel_->plan().tables().knots[d.index].at;
    const auto above = std::upper_bound(knots.begin(), knots.end(), c[0]);
    const double value = c[0];
    const auto far_from = [&](double knot) {
      c[0] = value - knot;
      return keeps_sign(c.data(), order_ - 1, horizon);
    };
    return (above != knots.end() && !far_from(*above)) || (above != knots.begin() && !far_from(*std::prev(above)));
  });
}

void KernelExpansion::read(MotionState<double>& m, bool expanded) const {
  if (!holds_) return;
  if (mapped()) {
    kernel_->fetch(lane_, Kernel::Moment::now, m.own, m.own_leading);
    kernel_->reader(lane_).motion(m.t, m.own, m.state);
  } else {
    kernel_->fetch(lane_, Kernel::Moment::now, m.state, m.leading);
  }
  if (expanded || mapped()) m.leading = leading();
}

// During an expansion nothing can be read of it.
void KernelExpansion::read_begun(MotionTrack<double>& track) const {
  if (!holds_) return;
  const auto put = [&](MotionTrack<double>::Begun& b, Kernel::Moment moment) {
    MotionState<double>& m = b.at.motion;
    if (!b.by_kernel) return;
    if (mapped()) {
      kernel_->fetch(lane_, moment, m.own, m.own_leading);
      m.leading.assign(program_->unknowns(), W(0));
      if (m.state.empty()) kernel_->reader(lane_).motion(m.t, m.own, m.state);
    } else {
      kernel_->fetch(lane_, moment, m.state, m.leading);
    }
    m.carry.assign(m.state.size(), W(0));
  };
  put(track.begun(), Kernel::Moment::begun);
  put(track.previous(), Kernel::Moment::before);
}

void KernelExpansion::take_back(MotionTrack<double>& track, bool expanded) {
  read(track.now, expanded);
  read_begun(track);
  holds_ = false;
}

void KernelExpansion::take_back_as_begun(MotionTrack<double>& track) {
  take_back(track, false);
  track.now.state = track.begun().at.motion.state;
  track.now.leading = track.begun().at.motion.leading;
  track.now.own.clear();
  track.begun().by_kernel = false;
}

std::vector<KernelExpansion::W> KernelExpansion::base(const W& begun) const {
  std::vector<W> own, state;
  kernel_->fetch_base(lane_, own);
  if (!mapped()) return own;
  kernel_->reader(lane_).motion(begun, own, state);
  return state;
}

std::vector<KernelExpansion::W> KernelExpansion::leading() const {
  std::vector<W> leading(program_->unknowns());
  kernel_->show_last();
  for (std::size_t j = 0; j < leading.size(); ++j)
    if (const auto own = own_unknown(j)) leading[j] = W(kernel_->derivative(*own, program_->d[j], lane_));
  return leading;
}

// Returns the kernel's unknown that is the motion's unknown j.
std::optional<std::size_t> KernelExpansion::own_unknown(std::size_t j) const {
  return mapped() ? kernel_->plan().map()->own(j, program_->unknowns()) : std::optional<std::size_t>(j);
}

double KernelExpansion::coefficient(std::size_t j, int k) const {
  const auto own = own_unknown(j);
  const Plan& plan = kernel_->plan().plan();
  return own && k <= plan.stages + plan.d[*own] ? kernel_->coefficient(*own, k, lane_) : 0;
}

bool KernelExpansion::add_hidden_points(std::uint32_t end, double h, std::vector<double>& points) const {
  const Plan& plan = kernel_->plan().plan();
  if (plan.hiding.empty()) return true;
  kernel_->show_last();
  std::vector<double> argument, value;
  bool reach = true;
  for (const Plan::HidingSeries& slot : plan.hiding) {
    if (slot.slot >= end || hides_nothing(slot.function, kernel_->whole_series(slot.argument, lane_),
                                          static_cast<std::size_t>(kernel_->lanes()), order_ - 1, h))
      continue;
    argument.resize(static_cast<std::size_t>(order_)), value.resize(argument.size());
    for (int k = 0; k < order_; ++k) {
      argument[static_cast<std::size_t>(k)] = kernel_->series(slot.argument, k, lane_);
      value[static_cast<std::size_t>(k)] = kernel_->series(slot.value, k, lane_);
    }
    if (!anholon::add_hidden_points(slot.function, argument.data(), value.data(), order_ - 1, h, points)) reach = false;
  }
  return reach;
}

void KernelExpansion::state_at(const W& begun, const W& h, std::vector<W>& state, std::vector<W>& leading) const {
  if (h == 0) {
    state = base(begun);
    leading = this->leading();
    return;
  }
  kernel_->set_step(lane_, static_cast<double>(h));
  kernel_->change_over_step();
  std::vector<W> from;
  kernel_->fetch_base(lane_, from);
  if (!mapped()) return advanced(h, from, state, leading);
  std::vector<W> own, own_leading;
  advanced(h, from, own, own_leading);
  kernel_->reader(lane_).motion(begun + h, own, state);
  leading = this->leading();
}

void KernelExpansion::own_state_at(const W& h, std::vector<W>& own, std::vector<W>& leading) const {
  kernel_->set_step(lane_, static_cast<double>(h));
  kernel_->change_over_step();
  kernel_->fetch_changed(lane_, own);
  leading.resize(program_->unknowns());
  for (std::size_t j = 0; j < leading.size(); ++j) {
    const auto in_kernel = own_unknown(j);
    leading[j] = in_kernel ? W(kernel_->derivative(*in_kernel, program_->d[j], lane_)) : W(0);
  }
}

void KernelExpansion::send(double h, double t) {
  kernel_->set_step(lane_, h);
  kernel_->set_time(lane_, t);
}

VelocityJump KernelExpansion::velocity_jump(double t) const {
  std::vector<W> own, foretold, state;
  kernel_->fetch(lane_, Kernel::Moment::now, own, foretold);
  kernel_->reader(lane_).motion(t, own, state);
  VelocityJump jump;
  for (const W& x : own) jump.size = std::max(jump.size, static_cast<double>(abs(x)));
  for (std::size_t a = 0; a < kernel_->plan().map()->coordinates(); ++a) {
    const W& velocity = state[2 * a + 1];
    if (const double change(abs(W(velocity - foretold[a]))); !(change <= jump.most)) jump.most = change;
    jump.speed = std::max(jump.speed, static_cast<double>(abs(foretold[a])));
  }
  return jump;
}

bool KernelExpansion::follow(MotionTrack<double>& track, const W& h) {
  MotionState<double>& m = track.now;
  if (mapped()) holds_ = true;  // the state that was taken back is unchanged
  if (holds_) {
    if (!blows_up()) return true;
    take_back(track, true);
    m.state = base(track.begun().at.motion.t);
    m.leading = leading();
    m.own.clear();
    return false;
  }
  const std::vector<W> from = m.state;
  advanced(h, from, m.state, m.leading);
  if (std::all_of(m.state.begin(), m.state.end(), [](const W& x) { return abs(x) < W(kBlowUp); })) return true;
  m.state = from;
  return false;
}

// Computes the solution at h beyond the point of the expansion, in the unknowns of the kernel, by its increments. The
// part t of the wider state that the kernel does not see adds t_i h^(i-k) / (i-k)!.
void KernelExpansion::advanced(const W& h, const std::vector<W>& base, std::vector<W>& state,
                               std::vector<W>& leading) const {
  kernel_->show_last();
  const Program& p = kernel_->plan().program();
  const std::size_t stride = static_cast<std::size_t>(kernel_->lanes());
  const double *increment = kernel_->increments(lane_), *factorial = kernel_->plan().tables().factorial.data();
  state.resize(base.size());
  leading.resize(p.unknowns());
  const W* from = base.data();
  W* to = state.data();
  for (std::size_t j = 0; j < p.unknowns(); ++j) {
    const double* x = kernel_->unknown(j, lane_);
    const int d = p.d[j];
    for (int k = 0; k < d; ++k, increment += stride) {
      W s = from[k] + *increment, power = h;
      for (int i = k + 1; i < d; ++i) {
        s += (from[i] - W(x[static_cast<std::size_t>(i) * stride] * factorial[i])) * power;
        power *= h / W(i - k + 1);
      }
      to[k] = s;
    }
    leading[j] = x[static_cast<std::size_t>(d) * stride] * factorial[d] + *increment;
    increment += stride;
    from += d;
    to += d;
  }
}

}  // namespace anholon
