#include "integrate/states/bdf.h"

#include <cmath>

#include "base/assert.h"

namespace anholon {

// Errors of low-order steps add up over the many steps that BDF takes. Each step may make this part of the tolerance,
// so that the motion is as accurate as by the other methods.
constexpr double kOfTolerance = 0.01;

static std::vector<double> narrow(const std::vector<long double>& list) { return {list.begin(), list.end()}; }

Bdf::Bdf(StateRate rate, const StepSettings& settings) : rate_(std::move(rate)), settings_(settings) {}

Outcome Bdf::start(const MotionPoint& from, long double end) {
  ANHOLON_ASSERT(rate_);
  SundialsSettings settings;
  settings.integral_tolerance = std::exp(settings_.log_tolerance);
  settings.tolerance = kOfTolerance * settings.integral_tolerance;
  settings.most_steps = settings_.most_steps;
  settings.cancelled = settings_.cancelled;
  stops_ = {rate_->program(), rate_->parameters(), known_quadratures(settings_), from.t, end};
  end_ = static_cast<double>(end);
  now_ = before_ = from;
  paces_.begin(from.t, steps_);
  motion_.emplace(std::move(*rate_), settings, static_cast<double>(from.t), static_cast<double>(end),
                  narrow(from.state), from.leading, narrow(from.integrals));
  rate_.reset();
  aim_beyond(static_cast<double>(from.t));
  return {};
}

// Lets steps from t end at the next time at which the time alone decides.
void Bdf::aim_beyond(double t) {
  // Steps shorter than so many round-offs are none for CVODE.
  constexpr double kLeast = 256 * 0x1p-53;
  stop_ = stops_.next(t, end_);
  while (stop_ && !(std::abs(stop_->before - t) > kLeast * std::abs(t))) stop_ = stops_.next(stop_->behind, end_);
  motion_->stop_at(stop_ ? stop_->before : end_);
}

double Bdf::more_work() const {
  if (!motion_) return 0;
  const double n = static_cast<double>(now_.state.size() + now_.integrals.size());
  return static_cast<double>(motion_->setups()) * n * n * n / 3;
}

Outcome Bdf::step(long double end) {
  const double last = std::abs(static_cast<double>(now_.t - before_.t));
  if (paces_.out_of_reach(settings_, steps_, now_.t, last, static_cast<double>(end - now_.t)))
    return end_out_of_reach(settings_, last);
  if (stop_ && (now_.t == stop_->before || now_.t == stop_->behind)) {
    motion_->go_on_from(static_cast<double>(now_.t), narrow(now_.state), now_.leading, narrow(now_.integrals));
    aim_beyond(stop_->behind);
  }
  if (Outcome o = motion_->step(); !o.ok()) return o;
  std::swap(before_, now_);
  put(now_);
  // Without a value behind the kink the motion stays before it, and the next step fails by itself.
  if (stop_ && now_.t == stop_->before && stop_->behind != stop_->before && motion_->pass(stop_->behind).ok())
    put(now_);
  if (now_.t == static_cast<double>(end)) now_.t = end;
  ++steps_;
  worst_constraint_ = motion_->drift();
  return {};
}

Outcome Bdf::at(long double t, MotionPoint& point) {
  if (t == before_.t || t == now_.t) {
    point = t == now_.t ? now_ : before_;
    return {};
  }
  // A kink has been passed without a step, by a few round-offs.
  if (stop_ && now_.t == stop_->behind && stop_->within(t)) {
    point = now_;
    point.t = t;
    return {};
  }
  if (Outcome o = motion_->advance(static_cast<double>(t)); !o.ok()) return o;
  put(point);
  return {};
}

void Bdf::put(MotionPoint& point) const {
  point.t = motion_->time();
  point.state.assign(motion_->state().begin(), motion_->state().end());
  point.leading = motion_->leading();
  point.integrals.assign(motion_->integrals().begin(), motion_->integrals().end());
}

}  // namespace anholon
