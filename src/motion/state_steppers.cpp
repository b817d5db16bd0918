#include "motion/state_steppers.h"

#include <cmath>
#include <limits>

#include "integrate/states/bdf.h"
#include "integrate/states/runge_kutta.h"
#include "kernel/kernel.h"

namespace anholon {

namespace {

// The reference takes this many times the operations of a kernel.
constexpr double kReference = 6;

// The overhead of an expansion, in operations.
constexpr double kExpansion = 300;
// The operations of the rates alone: values are quicker than series, but J is examined at every point.
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

// The operations of an expansion; kStep is the overhead of a step of a stage.
double work_of_expansion(const KernelPlan& plan) {
  constexpr double kStep = 16;
  const double steps = static_cast<double>(plan.plan().stage.size() + plan.plan().after.size());
  return plan.work() + kStep * steps * (plan.plan().stages + 1) + kExpansion;
}

MotionPoint present_point(const Stepper<double>& taylor, const Program& program) {
  MotionPoint p;
  p.t = taylor.time();
  p.state = taylor.state();
  p.integrals = taylor.integrals();
  for (std::size_t j = 0; j < taylor.unknowns(); ++j)
    p.leading.push_back(to_double(taylor.point().derivative(j, program.d[j])));
  return p;
}

StateSteppers::StateSteppers(const Motion<double>& motion, const Model& model, const StepSettings& settings,
                             std::vector<Guard> guards, bool counts)
    : motion_(motion), model_(model), settings_(settings), guards_(std::move(guards)), counts_(counts) {}

// Makes the plans again if the equations have changed.
void StateSteppers::make_plans() {
  const Program* equations = motion_.plan() ? &motion_.plan()->program() : &motion_.program();
  if (planned_ == equations) return;
  planned_ = equations;
  const MotionPoint from = present_point(motion_);
  const auto plan = [&](int stages) {
    return KernelPlan::make(program_of(motion_.unmapped_plan(), motion_.program()), stages, motion_.parameters(),
                            static_cast<double>(from.t), {from.state.begin(), from.state.end()});
  };
  plan_ = settings_.kernel ? plan(0) : nullptr;
  expansion_work_ = std::numeric_limits<double>::infinity();
  if (!counts_) return;
  if (motion_.plan())
    expansion_work_ = anholon::work_of_expansion(*motion_.plan());
  else if (const auto all = plan(motion_.stepper().order() - 1))
    expansion_work_ = kReference * anholon::work_of_expansion(*all);
}

std::unique_ptr<StateStepper> StateSteppers::make(Method method, double log_tolerance) {
  make_plans();
  StepSettings settings = settings_;
  settings.log_tolerance = log_tolerance;
  return make_state_stepper(method,
                            {motion_.program(), parameter_values<double>(model_), motion_.parameters(), plan_, guards_},
                            std::move(settings));
}

std::unique_ptr<StateStepper> make_state_stepper(Method method, StateRate rate, StepSettings settings) {
  if (info(method).raises_tolerance)
    settings.log_tolerance = std::max(settings.log_tolerance, std::log(info(method).least_tolerance));
  if (method == Method::bdf) return std::make_unique<Bdf>(std::move(rate), settings);
  return std::make_unique<RungeKutta>(std::move(rate), settings);
}

double work_of(StateStepper& stepper) {
  const StateRate& f = stepper.rate();
  const double evaluations =
      static_cast<double>(f.evaluations()) + (kReference - 1) * static_cast<double>(f.by_reference());
  return f.plan() ? evaluations * work_of_rates(*f.plan()) + stepper.more_work()
                  : std::numeric_limits<double>::infinity();
}

}  // namespace anholon
