#include "motion/state_motion.h"

#include <algorithm>

#include "integrate/sigma_schedule.h"
#include "numeric/told_time.h"

namespace anholon {

static std::vector<long double> widened(const std::vector<double>& from) { return {from.begin(), from.end()}; }

StateMotion::StateMotion(const Motion<double>& taylor, const std::vector<double>& parameters, int stages,
                         std::unique_ptr<StateStepper> stepper, StateRecord& record)
    : stepper_(std::move(stepper)), stages_(stages), point_(taylor.point()), begun_(taylor.stepper().point()),
      reference_(taylor.program(), parameters, 1), record_(record) {}

const Expansion<long double>& StateMotion::begin_step() {
  const MotionPoint& now = stepper_->now();
  begun_.load(now.t, now.state, widened(now.leading));
  return begun_;
}

Outcome StateMotion::step(long double end) {
  const std::optional<Pivots> pivots = stepper_->rate().pivots();
  Outcome o = stepper_->step(end);
  // Without a kernel there are no pivots, so the step is suspected.
  suspected_before_ = std::exchange(suspected_, !pivots || may_have_vanished(*pivots, *stepper_->rate().pivots()));
  return o;
}

// Returns the smallest singular value of J by the reference, which then has its expansion at p; nullopt if J has no
// values.
std::optional<double> StateMotion::sigma_at(const MotionPoint& p) {
  reference_.load(static_cast<double>(p.t), std::vector<double>(p.state.begin(), p.state.end()), p.leading);
  if (!reference_.prepare().ok()) return std::nullopt;
  return reference_.smallest_singular_value();
}

// A suspicion extends to the step after it.
bool StateMotion::passed_singular_point() {
  if (!suspected_ && !suspected_before_) return false;
  const auto mode_at = [&](const MotionPoint& p) -> std::optional<Mode<double>> {
    const std::optional<double> sigma = sigma_at(p);
    return sigma ? std::optional(weakest_mode(reference_, *sigma)) : std::nullopt;
  };
  const auto before = mode_at(stepper_->before());
  if (!before) return true;
  const auto after = mode_at(stepper_->now());
  return !after || crossed(*before, *after, reference_.program().system->coordinates);
}

void StateMotion::note_step() {
  record_.worst_constraint = std::max(record_.worst_constraint, static_cast<long double>(stepper_->worst_constraint()));
  const double health = stepper_->rate().pivots() ? stepper_->rate().pivots()->health : 1;
  if (!sigma_is_due(stepper_->steps()) && !(health < least_health_ * kPivotDropToRecheck)) return;
  least_health_ = std::min(least_health_, health);
  const MotionPoint& begun = stepper_->before();
  if (const std::optional<double> sigma = sigma_at(begun))
    record_.least_regular.see(*sigma, begun.t, reference_.weakest_direction());
}

Outcome StateMotion::at(W t) {
  MotionPoint p;
  Outcome o = stepper_->at(t, p);
  if (o.ok()) {
    point_.load(t, p.state, widened(p.leading));
    o = point_.prepare();
    if (o.ok()) o = point_.project();
    if (o.ok()) o = point_.solve();
  }
  if (!o.ok())
    tell_time(o, to_double(t));
  else if (stages_ > 0)
    o = point_.extend();
  return o;
}

}  // namespace anholon
