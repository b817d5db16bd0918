#include "motion/method_choice.h"

#include <cmath>
#include <limits>
#include <utility>

#include "kernel/kernel.h"
#include "motion/stiff_method.h"

namespace anholon {

Method stiff_method() { return Method::bdf; }

namespace {

const double kLoose = std::log(1e-5), kBdf = std::log(info(Method::bdf).least_tolerance);
// Another method has to be this many times cheaper than Taylor's on a stretch of so many of its steps. The factor of
// BDF is larger, because its errors grow faster; for stiff motions it is much cheaper.
constexpr double kCheaper = 1.3, kMuchCheaper = 4;
constexpr std::size_t kFewSteps = 48, kManySteps = 256;
// A trial after many kinks is made again when there are this many times as many.
constexpr std::size_t kOftener = 8;
// A trial that has used the part kEarly of its operations has to have covered the part kFar of its way; otherwise it is
// given up.
constexpr double kEarly = 0.25, kFar = 0.05;
// A motion that has taken kLong of Taylor's steps may be long because it is stiff. Advice is given if BDF is
// kWorthAdvice times cheaper.
constexpr std::size_t kLong = 16 * kFirstStiff;
constexpr double kWorthAdvice = 16;
// The factor for a motion in the lanes of a kernel, whose operations are this many times cheaper than those of a trial.
constexpr double kMuchCheaperThanLanes = 16;

// The end of a trial, which goes as far as Taylor's last steps did, or to the end of the motion, and the cost of
// Taylor's method on the same way.
struct TrialStretch {
  long double to = 0;
  double costs = 0;
  TrialStretch(const MotionPoint& from, long double since, double work_of_steps, long double end) {
    const long double span = from.t - since, left = end - from.t;
    const bool whole = std::abs(span) < std::abs(left);
    to = whole ? from.t + span : end;
    costs = work_of_steps * (whole ? 1.0 : std::abs(static_cast<double>(left / span)));
  }
};

// True if a stepper gets from a point to a time with at most so many operations.
bool comes_to(StateStepper& stepper, const MotionPoint& from, long double to, double most) {
  bool good = stepper.start(from, to).ok();
  while (good && !(stepper.now().t == to)) {
    good = stepper.step(to).ok() && !(work_of(stepper) > most);
    const double progress = std::abs(static_cast<double>((stepper.now().t - from.t) / (to - from.t)));
    if (work_of(stepper) > kEarly * most && progress < kFar) good = false;
  }
  return good;
}

}  // namespace

void MethodChoice::note_step(long double t) {
  if (times_.size() > 2 * kManySteps)
    times_.erase(times_.begin(), times_.end() - static_cast<std::ptrdiff_t>(kManySteps + 1));
  times_.push_back(t);
}

std::optional<MethodChoice::Turn> MethodChoice::leave_taylor(long double end) {
  const Stepper<double>& taylor = motion_.stepper();
  const std::size_t steps = taylor.steps();
  // A trial does not pay if the end is near.
  const auto far = [&](std::size_t stretch, double times) {
    if (times_.size() <= stretch) return false;
    const long double pace =
        (taylor.time() - times_[times_.size() - 1 - stretch]) / static_cast<long double>(static_cast<double>(stretch));
    return std::abs(end - taylor.time()) >
           std::abs(pace) * static_cast<long double>(times * static_cast<double>(steps));
  };
  if (log_tolerance_ >= kLoose && steps == kFewSteps + 1 && far(kFewSteps, 4) &&
      pays(Method::runge_kutta, kFewSteps, kCheaper, end))
    return Turn{Method::runge_kutta, "the tolerance is loose: " + percent()};
  if (taylor.kinks() >= next_kinks_ && times_.size() > kFewSteps) {
    next_kinks_ = kOftener * taylor.kinks();
    if (pays(Method::runge_kutta, kFewSteps, kCheaper, end))
      return Turn{Method::runge_kutta, "the motion has met many kinks: " + percent()};
  }
  if (steps < next_stiff_ || !far(kManySteps, 1)) return std::nullopt;
  if (log_tolerance_ >= kBdf) return leave_for_bdf(end);
  next_stiff_ = 2 * steps;
  if (steps >= kLong && steps < 2 * kLong) look_for_advice(end);
  return std::nullopt;
}

// Returns the steps for which leave_taylor() surely returns nullopt. Trials begin after fixed numbers of steps. An end
// that is too near for a trial by a tenth remains too near, as far as the pace of the last steps after `most` further
// ones can be bounded.
std::size_t MethodChoice::stays_with_taylor(long double end, std::size_t most) const {
  constexpr long double kSurely = 0.9L;
  const Stepper<double>& taylor = motion_.stepper();
  const std::size_t steps = taylor.steps(), known = times_.size();
  if (taylor.kinks() >= next_kinks_) return 1;
  most = std::min(most, kManySteps / 2);
  if (log_tolerance_ >= kLoose && steps <= kFewSteps) most = std::min(most, kFewSteps + 1 - steps);
  if (steps < next_stiff_) return std::min(most, next_stiff_ - steps);
  if (known <= kManySteps) return std::min(most, kManySteps + 1 - known);
  const long double passed = times_[known - 1] - times_[known - 1 - kManySteps + most],
                    pace = std::abs(passed) / static_cast<long double>(static_cast<double>(kManySteps));
  return std::abs(end - taylor.time()) < kSurely * pace * static_cast<long double>(static_cast<double>(steps)) ? most
                                                                                                               : 1;
}

std::optional<MethodChoice::Turn> MethodChoice::leave_for_bdf(long double end) {
  next_stiff_ = 2 * motion_.stepper().steps();
  if (log_tolerance_ < kBdf) {
    look_for_advice(end);
    return std::nullopt;
  }
  if (!pays(Method::bdf, kManySteps, kMuchCheaper, end)) return std::nullopt;
  return Turn{Method::bdf, "the motion is stiff: " + percent()};
}

// Looks whether BDF would make the motion shorter, whose tolerance is too tight for BDF. The trial is not counted.
void MethodChoice::look_for_advice(long double end) {
  const Trials before = trials_;
  if (const auto trial = steppers_.make(Method::bdf, kBdf);
      times_.size() > kManySteps && pays(*trial, kManySteps, kMuchCheaper, end) && ratio_ * kWorthAdvice < 1)
    advice_ = "the motion is stiff: BDF, which serves tolerances of " +
              number_text(info(Method::bdf).least_tolerance, 3) + " and more, would take " + percent();
  trials_ = before;
}

bool MethodChoice::pays(Method method, std::size_t steps, double factor, long double end) {
  if (times_.size() <= steps) return false;
  const auto trial = steppers_.make(method);
  return pays(*trial, steps, factor, end);
}

// True if the stepper gets from here as far as Taylor's last `steps` did, with `factor` times fewer operations.
bool MethodChoice::pays(StateStepper& trial, std::size_t steps, double factor, long double end) {
  const MotionPoint from = present_point(motion_);
  if (!steppers_.plan() || !std::isfinite(steppers_.work_of_expansion())) return false;
  const long double since = times_[times_.size() - 1 - steps];
  const double work = steppers_.work_of_expansion() * static_cast<double>(steps);
  const TrialStretch stretch(from, since, work, end);
  taylor_pace_ = work / std::abs(static_cast<double>(from.t - since));
  ++trials_.count;
  const bool good = comes_to(trial, from, stretch.to, stretch.costs / factor);
  trials_.evaluations += trial.rate().evaluations();
  ratio_ = work_of(trial) / stretch.costs;
  return good;
}

void TaylorWatch::begin(const Stepper<double>& stepper) {
  kinks_before_ = stepper.kinks();
  next_kinks_ = kFirstKinks;
  next_stiff_ = kFirstStiff;
  stiff_ = {}, kinky_ = {};
}

std::size_t TaylorWatch::steps_to_look(std::size_t steps) const {
  if (log_tolerance_ < kBdf) return std::numeric_limits<std::size_t>::max();
  const std::size_t mark = next_stiff_ - kManySteps;
  return steps < mark ? mark - steps : next_stiff_ - steps;
}

bool TaylorWatch::another_pays(Stepper<double>& taylor, const Equations& equations, long double end) {
  const std::size_t steps = taylor.steps(), kinks = taylor.kinks() - kinks_before_;
  const Mark now{taylor.time(), steps};
  if (kinks >= next_kinks_) {
    if (!kinky_) kinky_ = now;
    if (steps - kinky_->steps >= kFewSteps) {
      next_kinks_ = kOftener * kinks;
      if (pays(Method::runge_kutta, *std::exchange(kinky_, std::nullopt), taylor, equations, end)) return true;
    }
  }
  if (log_tolerance_ < kBdf) return false;
  if (steps + kManySteps == next_stiff_) stiff_ = now;
  if (steps < next_stiff_) return false;
  next_stiff_ *= 2;
  const std::optional<Mark> since = std::exchange(stiff_, std::nullopt);
  if (!since) return false;
  const long double pace = std::abs(now.t - since->t) / static_cast<long double>(static_cast<double>(kManySteps));
  return std::abs(end - now.t) > pace * static_cast<long double>(static_cast<double>(steps)) &&
         pays(Method::bdf, *since, taylor, equations, end);
}

bool TaylorWatch::pays(Method method, const Mark& since, Stepper<double>& taylor, const Equations& equations,
                       long double end) const {
  taylor.leave_kernel();
  const MotionPoint from = present_point(taylor, *equations.program);
  const TrialStretch stretch(
      from, since.t, work_of_expansion(*equations.expansions) * static_cast<double>(taylor.steps() - since.steps), end);
  StepSettings settings;
  settings.log_tolerance = log_tolerance_;
  const auto trial = make_state_stepper(
      method, {*equations.program, *equations.parameters, *equations.wide_parameters, equations.rates}, settings);
  return comes_to(*trial, from, stretch.to, stretch.costs / kMuchCheaper) &&
         work_of(*trial) * kMuchCheaperThanLanes < stretch.costs;
}

std::string MethodChoice::percent() const {
  return number_text(100 * ratio_, 2) + " % of Taylor's operations on the same stretch";
}

void MethodChoice::begin_other() {
  times_.clear();
  stretch_ = {static_cast<double>(motion_.stepper().time()), 0, 0};
}

bool MethodChoice::slower_than_taylor(StateStepper& other) {
  if (other.steps() < stretch_.steps + kManySteps) return false;
  const Stretch now{static_cast<double>(other.now().t), work_of(other), other.steps()};
  const double pace = (now.work - stretch_.work) / std::abs(now.t - stretch_.t);
  stretch_ = now;
  return pace > taylor_pace_;
}

}  // namespace anholon
