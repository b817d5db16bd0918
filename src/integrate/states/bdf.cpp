#include "integrate/states/bdf.h"

#include <cmath>

#include "base/assert.h"

namespace anholon {

// Errors of low-order steps add up over the many steps that BDF takes. Each step may make this part of the tolerance,
// so that the motion is as accurate as by the other methods.
constexpr double kOfTolerance = 0.01;

Bdf::Bdf(StateRate rate, const StepSettings& settings) : rate_(std::move(rate)), settings_(settings) {}

Outcome Bdf::start(const MotionPoint& from, long double end) {
  ANHOLON_ASSERT(rate_);
  const auto narrow = [](const std::vector<long double>& list) {
    return std::vector<double>(list.begin(), list.end());
  };
  SundialsSettings settings;
  settings.integral_tolerance = std::exp(settings_.log_tolerance);
  settings.tolerance = kOfTolerance * settings.integral_tolerance;
  settings.most_steps = settings_.most_steps;
  settings.cancelled = settings_.cancelled;
  now_ = before_ = from;
  paces_.begin(from.t, steps_);
  motion_.emplace(std::move(*rate_), settings, static_cast<double>(from.t), static_cast<double>(end),
                  narrow(from.state), from.leading, narrow(from.integrals));
  rate_.reset();
  return {};
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
  if (Outcome o = motion_->step(); !o.ok()) return o;
  std::swap(before_, now_);
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
