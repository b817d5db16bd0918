// Makes the steppers of methods other than Taylor's for a motion, and counts the operations of both.
//
// Operations are counted on the plans, never measured in time: the same motion has the same counts on every machine.
#pragma once
#include "integrate/states/state_rate.h"
#include "model/methods.h"
#include "motion/motion.h"

namespace anholon {

// Where Taylor's motion has come to.
MotionPoint present_point(const Motion<double>& motion);

class StateSteppers {
 public:
  // `counts`: the operations of Taylor's expansions will be asked for.
  StateSteppers(const Motion<double>& motion, const Model& model, const StepSettings& settings,
                std::vector<Guard> guards, bool counts);

  // A stepper of runge_kutta or bdf, from where the motion is.
  std::unique_ptr<StateStepper> make(Method method);
  // The plan of the rates of the last stepper made; null if no kernel computes them.
  const std::shared_ptr<const KernelPlan>& plan() const { return plan_; }
  // Operations of one of Taylor's expansions; infinity if no kernel makes them.
  double work_of_expansion() const { return expansion_work_; }

 private:
  void make_plans();

  const Motion<double>& motion_;
  const Model& model_;
  StepSettings settings_;
  std::vector<Guard> guards_;
  bool counts_;
  const Program* planned_ = nullptr;  // the equations that the plan is made of
  std::shared_ptr<const KernelPlan> plan_;
  double expansion_work_ = 0;
};

// Operations that a stepper has taken; infinity without a kernel.
double work_of(StateStepper& stepper);

}  // namespace anholon
