// Makes the steppers of methods other than Taylor's for a motion, and counts the operations of both.
//
// Operations are counted on the plans, never measured in time: the same motion has the same counts on every machine.
#pragma once
#include <mutex>

#include "integrate/states/state_rate.h"
#include "model/methods.h"
#include "motion/motion.h"

namespace anholon {

// The point where Taylor's motion is.
MotionPoint present_point(const Stepper<double>& taylor, const Program& program);
inline MotionPoint present_point(const Motion<double>& motion) {
  return present_point(motion.stepper(), motion.program());
}

class StateSteppers {
 public:
  // `counts`: the operations of Taylor's expansions will be needed.
  StateSteppers(const Motion<double>& motion, const Model& model, const StepSettings& settings,
                std::vector<Guard> guards, bool counts);

  // Returns a stepper of runge_kutta or bdf that starts where the motion is; with the tolerance of the motion, or a
  // looser one.
  std::unique_ptr<StateStepper> make(Method method) { return make(method, settings_.log_tolerance); }
  std::unique_ptr<StateStepper> make(Method method, double log_tolerance);
  // The plan of the rates of the last stepper made; nullptr if no kernel computes them.
  const std::shared_ptr<const KernelPlan>& plan() const { return plan_; }
  // The operations of one of Taylor's expansions; infinity if no kernel makes them.
  double work_of_expansion() const { return expansion_work_; }

 private:
  void make_plans();

  const Motion<double>& motion_;
  const Model& model_;
  StepSettings settings_;
  std::vector<Guard> guards_;
  bool counts_;
  const Program* planned_ = nullptr;  // the equations of the plan
  std::shared_ptr<const KernelPlan> plan_;
  double expansion_work_ = 0;
};

// The kernel plan of the rates of a program, made at the first request, from any thread.
class RatesOnDemand {
 public:
  // `state`: the state at and around which the pivots are chosen.
  RatesOnDemand(std::shared_ptr<const Program> program, std::vector<long double> parameters, double t,
                std::vector<double> state)
      : program_(std::move(program)), parameters_(std::move(parameters)), t_(t), state_(std::move(state)) {}
  // Returns nullptr if the program has no such plan.
  const std::shared_ptr<const KernelPlan>& plan() const {
    std::call_once(made_, [&] { plan_ = KernelPlan::make(program_, 0, parameters_, t_, state_); });
    return plan_;
  }

 private:
  std::shared_ptr<const Program> program_;
  std::vector<long double> parameters_;
  double t_;
  std::vector<double> state_;
  mutable std::once_flag made_;
  mutable std::shared_ptr<const KernelPlan> plan_;
};

// Makes a stepper of runge_kutta or bdf.
std::unique_ptr<StateStepper> make_state_stepper(Method method, StateRate rate, StepSettings settings);
// The operations of one of Taylor's expansions by a kernel.
double work_of_expansion(const KernelPlan& plan);
// The operations that a stepper has taken; infinity without a kernel.
double work_of(StateStepper& stepper);

}  // namespace anholon
