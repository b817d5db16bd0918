// A stretch of a motion by a method other than Taylor's: its steps, the solution within the last one, and a watch on
// the system Jacobian J. Such a method passes points where J is singular without noticing them.
#pragma once
#include "integrate/states/state_rate.h"
#include "motion/motion.h"

namespace anholon {

// The record of all stretches so far.
struct StateRecord {
  long double worst_constraint = 0;
  LeastRegular<double> least_regular;
};

class StateMotion {
 public:
  using W = long double;

  // Starts where Taylor's motion is. `stages`: the orders beyond the leading derivatives in point(). The record
  // outlives the stretch.
  StateMotion(const Motion<double>& taylor, const std::vector<double>& parameters, int stages,
              std::unique_ptr<StateStepper> stepper, StateRecord& record);

  // Loads the point where the next step begins; begun() returns it.
  const Expansion<W>& begin_step();
  Outcome step(long double end);
  // True if J was singular within the last step. The reference decides if the kernel's pivots do not exclude it.
  bool passed_singular_point();
  // Notes in the record how the last step kept the constraints and, if that is due, how regular J was where it began.
  void note_step();

  // Computes the solution at any time of the last step.
  Outcome at(W t);
  const Expansion<W>& point() const { return point_; }
  const Expansion<W>& begun() const { return begun_; }

  StateStepper& stepper() { return *stepper_; }
  const StateStepper& stepper() const { return *stepper_; }

 private:
  std::optional<double> sigma_at(const MotionPoint& p);

  std::unique_ptr<StateStepper> stepper_;
  int stages_;
  Expansion<W> point_, begun_;
  Expansion<double> reference_;
  StateRecord& record_;
  double least_health_ = 1;
  bool suspected_ = false, suspected_before_ = false;  // by the pivots: J may be singular close to the last steps
};

}  // namespace anholon
