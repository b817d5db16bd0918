// What makes another method, and whether it pays: operations are counted on a stretch of the motion itself.
#include <cmath>
#include <limits>

#include "integrate/states/bdf.h"
#include "integrate/states/runge_kutta.h"
#include "kernel/kernel.h"
#include "motion/course.h"

namespace anholon {

namespace {

const double kLoose = std::log(1e-5), kBdf = std::log(info(Method::bdf).least_tolerance);
// Another method has to be so many times cheaper than Taylor on a stretch of so many of its steps: BDF by more, as its
// errors grow faster. Where a motion is stiff it is cheaper by far.
constexpr double kCheaper = 1.3, kMuchCheaper = 4;
constexpr std::size_t kFewSteps = 48;
// Where there are many kinks it is asked again when they are so many times as many.
constexpr std::size_t kOftener = 8;
// A trial that has spent this part of what it may spend has come this far, or is given up.
constexpr double kEarly = 0.25, kFar = 0.05;
// The reference takes so many times the operations of a kernel.
constexpr double kReference = 6;

// Operations of an expansion by a plan. What it takes to come to a step, and to an expansion, weighs as much as so many
// of them.
constexpr double kExpansion = 300;
double work(const KernelPlan& plan) {
  constexpr double kStep = 16;
  const double steps = static_cast<double>(plan.plan().stage.size() + plan.plan().after.size());
  return plan.work() + kStep * steps * (plan.plan().stages + 1) + kExpansion;
}

// Of the rates alone: values are quicker than series, and all that is known of J is asked for at every point.
double work_of_rates(const KernelPlan& plan) {
  constexpr double kStep = 11, kEntry = 6;
  const double steps = static_cast<double>(plan.plan().point.size() + plan.plan().after.size());
  return plan.work() + kStep * steps +
         kEntry * (plan.elimination().work() +
                   static_cast<double>(plan.elimination().update_list.size() + plan.plan().entries.size())) +
         kExpansion;
}

std::shared_ptr<const Program> program_of(const std::shared_ptr<const KernelPlan>& plan, const Program& otherwise) {
  if (plan) return {plan, &plan->program()};
  return std::make_shared<const Program>(otherwise);
}

}  // namespace

template <Number N>
MotionPoint Course<N>::here() const {
  MotionPoint p;
  if constexpr (std::same_as<N, double>) {
    const Stepper<N>& taylor = motion_.stepper();
    p.t = taylor.time();
    p.state = taylor.state();
    p.integrals = taylor.integrals();
    for (std::size_t j = 0; j < taylor.unknowns(); ++j)
      p.leading.push_back(to_double(taylor.point().derivative(j, motion_.program().d[j])));
  }
  return p;
}

// The plan of the rates, and what an expansion of Taylor's takes: as long as the equations are the same.
template <Number N>
void Course<N>::make_plans() {
  if constexpr (std::same_as<N, double>) {
    const Program* equations = motion_.plan() ? &motion_.plan()->program() : &motion_.program();
    if (planned_ == equations) return;
    planned_ = equations;
    const MotionPoint from = here();
    const auto plan = [&](int stages) {
      return KernelPlan::make(program_of(motion_.unmapped_plan(), motion_.program()), stages, motion_.parameters(),
                              static_cast<double>(from.t), {from.state.begin(), from.state.end()});
    };
    plan_ = settings_.kernel ? plan(0) : nullptr;
    expansion_work_ = std::numeric_limits<double>::infinity();
    if (!free_) return;
    if (motion_.plan())
      expansion_work_ = work(*motion_.plan());
    else if (const auto all = plan(motion_.stepper().order() - 1))
      expansion_work_ = kReference * work(*all);
  }
}

template <Number N>
std::unique_ptr<StateStepper> Course<N>::make(Method method) {
  if constexpr (std::same_as<N, double>) {
    make_plans();
    const Program& program = motion_.program();
    StateRate rate(program, parameter_values<double>(*s_.model), motion_.parameters(), plan_, guards_);
    StepSettings settings = settings_;
    settings.log_tolerance = std::max(settings.log_tolerance, std::log(info(Method::runge_kutta).least_tolerance));
    if (method == Method::bdf) return std::make_unique<Bdf>(std::move(rate), settings);
    return std::make_unique<RungeKutta>(std::move(rate), settings);
  } else {
    (void)method;
    return nullptr;
  }
}

template <Number N>
double Course<N>::spent(StateStepper& stepper) const {
  const KernelPlan* plan = stepper.rate().plan();
  const StateRate& f = stepper.rate();
  const double evaluations =
      static_cast<double>(f.evaluations()) + (kReference - 1) * static_cast<double>(f.by_reference());
  return plan ? evaluations * work_of_rates(*plan) + stepper.more_work() : std::numeric_limits<double>::infinity();
}

// Whether another method would come as far as Taylor's last steps did, from here on, with `factor` times fewer
// operations.
template <Number N>
bool Course<N>::pays(Method method, std::size_t steps, double factor, const W& end) {
  if constexpr (std::same_as<N, double>) {
    if (times_.size() <= steps) return false;
    const MotionPoint from = here();
    const W span = from.t - times_[times_.size() - 1 - steps], left = end - from.t;
    const bool whole = abs(span) < abs(left);
    const W to = whole ? W(from.t + span) : end;
    auto trial = make(method);
    if (!plan_ || !std::isfinite(expansion_work_)) return false;
    const double all = expansion_work_ * static_cast<double>(steps),
                 part = whole ? 1.0 : std::abs(static_cast<double>(left / span));
    const double costs = all * part, most = costs / factor;
    pace_ = all / std::abs(static_cast<double>(span));
    ++report_.trials;
    bool good = trial->start(from, to).ok();
    while (good && !(trial->now().t == to)) {
      good = trial->step(to).ok() && !(spent(*trial) > most);
      const double progress = std::abs(static_cast<double>((trial->now().t - from.t) / (to - from.t)));
      if (spent(*trial) > kEarly * most && progress < kFar) good = false;
    }
    report_.trial_evaluations += trial->rate().evaluations();
    ratio_ = spent(*trial) / costs;
    return good;
  } else {
    (void)method, (void)steps, (void)factor, (void)end;
    return false;
  }
}

template <Number N>
void Course<N>::turn(Method to, std::string why) {
  wanted_ = report_.last = to;
  report_.turns.push_back({to_double(time()), to, std::move(why)});
}

// Whether Taylor's steps, the last of which is made, are to go on.
template <Number N>
void Course<N>::choose(const W& end) {
  const Stepper<N>& taylor = motion_.stepper();
  const std::size_t steps = taylor.steps();
  // Where the end is near, nothing is won by a trial.
  const auto far = [&](std::size_t stretch, double times) {
    if (times_.size() <= stretch) return false;
    const W pace = (taylor.time() - times_[times_.size() - 1 - stretch]) / W(static_cast<double>(stretch));
    return abs(W(end - taylor.time())) > abs(pace) * W(times * static_cast<double>(steps));
  };
  if (settings_.log_tolerance >= kLoose && steps == kFewSteps + 1 && far(kFewSteps, 4) &&
      pays(Method::runge_kutta, kFewSteps, kCheaper, end))
    return turn(Method::runge_kutta, "the tolerance is loose: " + percent());
  if (taylor.kinks() >= next_kinks_ && times_.size() > kFewSteps) {
    next_kinks_ = kOftener * taylor.kinks();
    if (pays(Method::runge_kutta, kFewSteps, kCheaper, end))
      return turn(Method::runge_kutta, "the motion has met many kinks: " + percent());
  }
  if (steps >= next_stiff_ && far(kStretch, 1)) try_bdf(end);
}

template <Number N>
bool Course<N>::try_bdf(const W& end) {
  next_stiff_ = 2 * motion_.stepper().steps();
  if (settings_.log_tolerance < kBdf || !pays(Method::bdf, kStretch, kMuchCheaper, end)) return false;
  turn(Method::bdf, "the motion is stiff: " + percent());
  return true;
}

// Under auto alone: over a stretch of so many steps it has cost more than Taylor would.
template <Number N>
bool Course<N>::slower_than_taylor() {
  if (!free_ || other_->steps() < window_steps_ + kStretch) return false;
  const double now = static_cast<double>(other_->now().t), work = spent(*other_),
               pace = (work - window_spent_) / std::abs(now - window_t_);
  window_steps_ = other_->steps();
  window_t_ = now;
  window_spent_ = work;
  return pace > pace_;
}

#define INSTANTIATE(N)                                                                                                 \
  template MotionPoint Course<N>::here() const;                                                                        \
  template void Course<N>::make_plans();                                                                               \
  template std::unique_ptr<StateStepper> Course<N>::make(Method);                                                      \
  template double Course<N>::spent(StateStepper&) const;                                                               \
  template void Course<N>::turn(Method, std::string);                                                                  \
  template bool Course<N>::pays(Method, std::size_t, double, const Wider<N>&);                                         \
  template void Course<N>::choose(const Wider<N>&);                                                                    \
  template bool Course<N>::try_bdf(const Wider<N>&);                                                                   \
  template bool Course<N>::slower_than_taylor();
INSTANTIATE(double)
INSTANTIATE(long double)
INSTANTIATE(Quad)
INSTANTIATE(Multi)
#undef INSTANTIATE

}  // namespace anholon
