#include "integrate/lanes/ordinary_steps.h"

#include <algorithm>
#include <cmath>

namespace anholon {

namespace {

// Bounds are compared with this margin, which exceeds their round-off.
constexpr double kSurely = 1 - 1e-9;

// Returns the error of `sum` = fl(a + b): a + b is exactly `sum` plus the result.
double error_of_sum(double a, double b, double sum) {
  const double of_b = sum - a;
  return (a - (sum - of_b)) + (b - of_b);
}

// True if the sum in long double, rounded to double, is surely `sum` as well. It may not be if the sum lies nearly
// midway between two doubles.
bool is_same_sum(double sum, double error) { return sum + error * (1 + 0x1p-9) == sum; }

}  // namespace

OrdinarySteps::OrdinarySteps(std::shared_ptr<Kernel> kernel, const StepSettings& settings)
    : kernel_(std::move(kernel)), settings_(settings), check_(settings.log_tolerance),
      lanes_(static_cast<std::size_t>(kernel_->lanes())) {}

bool OrdinarySteps::run(std::span<const Motion> motions) {
  if (!take(motions)) return false;
  for (;;) {
    if (!aim()) {
      tell(motions, false);
      return false;
    }
    go();
    if (!arrives()) {
      tell(motions, true);
      return true;
    }
    finish();
    kernel_->begin();
  }
}

bool OrdinarySteps::take(std::span<const Motion> motions) {
  made_ = 0;
  most_ = std::numeric_limits<std::size_t>::max();
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    const Motion& m = motions[i];
    Lane& lane = lanes_[i];
    lane.sign = 0;
    if (!m.stepper) continue;
    const auto course = m.stepper->ordinary_course();
    if (!course) return false;
    lane.course = *course;
    lane.sign = m.end > m.stepper->time() ? 1 : -1;
    // The double before the one nearest to `until`.
    lane.until = std::nextafter(to_double(m.until), -lane.sign * std::numeric_limits<double>::infinity());
    lane.left = std::abs(to_double(m.end) - course->last.to) * (1 + 0x1p-50);
    most_ = std::min({most_, course->most, m.most - 1});
  }
  return most_ > 0;
}

bool OrdinarySteps::aim() {
  if (made_ == most_ || (settings_.cancelled && settings_.cancelled())) return false;
  for (std::size_t i = 0; i < lanes_.size(); ++i)
    if (lanes_[i].sign != 0 && !aim(lanes_[i], static_cast<int>(i))) return false;
  for (std::size_t i = 0; i < lanes_.size(); ++i)
    if (lanes_[i].sign != 0) kernel_->set_step(static_cast<int>(i), lanes_[i].length);
  if (kernel_->plan().plan().hiding.empty()) return true;
  kernel_->look_for_hidden();
  const double* hidden = kernel_->finding(&Findings::hidden);
  for (std::size_t i = 0; i < lanes_.size(); ++i)
    if (lanes_[i].sign != 0 && !(hidden[i] < kSurely)) return false;
  return true;
}

bool OrdinarySteps::aim(Lane& lane, int at) const {
  const OrdinaryCourse& c = lane.course;
  const double t = c.last.to, h = kernel_->reach(at), step = lane.sign * h;
  lane.pivots = kernel_->pivots(at);
  lane.to = t + step;
  lane.length = lane.to - t;
  lane.course.horizon = h;
  return !may_have_vanished(c.pivots, lane.pivots) && lane.pivots.health > c.least_health && kernel_->reaches(at) &&
         h > std::abs(t) * kShortStep && (lane.until - lane.to) * lane.sign > 0 &&
         lane.left <= h * static_cast<double>(c.most_ahead) && is_same_sum(lane.to, error_of_sum(t, step, lane.to)) &&
         error_of_sum(lane.to, -t, lane.length) == 0;
}

// All steps are aimed: the kernel goes to their ends.
void OrdinarySteps::go() {
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    if (lanes_[i].sign == 0) continue;
    OrdinaryCourse& c = lanes_[i].course;
    if (const double drift = kernel_->drift(static_cast<int>(i)); c.drift < drift) c.drift = drift;
    kernel_->set_time(static_cast<int>(i), lanes_[i].to);
  }
  kernel_->advance();
  kernel_->start_next();
}

bool OrdinarySteps::arrives() const {
  const double *defect = kernel_->finding(&Findings::defect), *largest = kernel_->finding(&Findings::largest);
  for (std::size_t i = 0; i < lanes_.size(); ++i)
    if (lanes_[i].sign != 0 && !(check_.passes_at_once(defect[i], lanes_[i].length) && largest[i] < kBlowUp))
      return false;
  return true;
}

void OrdinarySteps::finish() {
  ++made_;
  for (Lane& lane : lanes_) {
    OrdinaryCourse& c = lane.course;
    c.before = c.last;
    c.last = {lane.to, lane.length, c.drift};
    c.pivots = lane.pivots;
  }
}

void OrdinarySteps::tell(std::span<const Motion> motions, bool aimed) {
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    if (lanes_[i].sign == 0) continue;
    OrdinaryCourse& c = lanes_[i].course;
    c.steps = made_;
    c.aimed = aimed;
    if (aimed) c.end = lanes_[i].to, c.pivots = lanes_[i].pivots;
    motions[i].stepper->follow(c);
  }
}

}  // namespace anholon
