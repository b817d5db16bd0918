// Chooses a method during the motion (theory: methods): decides whether another method would get as far as Taylor's
// last steps did with fewer operations, by a trial on a stretch of the motion itself.
#pragma once
#include <utility>

#include "motion/state_steppers.h"

namespace anholon {

// The first trial is made after so many kinks, or after so many of Taylor's steps.
inline constexpr std::size_t kFirstKinks = 128, kFirstStiff = 2048;

class MethodChoice {
 public:
  struct Turn {
    Method to = Method::taylor;
    std::string why;
  };
  struct Trials {
    std::size_t count = 0, evaluations = 0;
  };

  MethodChoice(StateSteppers& steppers, const Motion<double>& motion, double log_tolerance)
      : steppers_(steppers), motion_(motion), log_tolerance_(log_tolerance) {}

  // Notes that Taylor's method has made a step to t.
  void note_step(long double t);
  // Returns the method that goes on towards `end` in place of Taylor's; nullopt if Taylor's method does.
  std::optional<Turn> leave_taylor(long double end);
  // Like leave_taylor(), for BDF alone.
  std::optional<Turn> leave_for_bdf(long double end);
  // After leave_taylor() has returned nullopt: the number of steps, from 1 to `most`, for which it will return nullopt
  // again if they meet no kink.
  std::size_t stays_with_taylor(long double end, std::size_t most) const;
  // Notes that another method has taken over where Taylor's motion is.
  void begin_other();
  // True if the other method has cost more than Taylor's would, over its last steps.
  bool slower_than_taylor(StateStepper& other);
  const Trials& trials() const { return trials_; }
  // Tells once what a looser tolerance would save in a long motion; empty if that is nothing, or was told before.
  std::string take_advice() { return std::exchange(advice_, {}); }

 private:
  bool pays(Method method, std::size_t steps, double factor, long double end);
  bool pays(StateStepper& trial, std::size_t steps, double factor, long double end);
  void look_for_advice(long double end);
  std::string percent() const;

  StateSteppers& steppers_;
  const Motion<double>& motion_;
  double log_tolerance_;
  std::vector<long double> times_;  // the ends of Taylor's last steps
  std::size_t next_kinks_ = kFirstKinks,
              next_stiff_ = kFirstStiff;  // kinks and steps after which the next trial is made
  double taylor_pace_ = 0;  // operations of Taylor's method for a unit of time where another method took over
  double ratio_ = 0;        // operations of the last trial, relative to Taylor's
  // The point where the present stretch of the other method began.
  struct Stretch {
    double t = 0, work = 0;
    std::size_t steps = 0;
  };
  Stretch stretch_;
  Trials trials_;
  std::string advice_;
};

// Decides whether a motion among many others in the lanes of a kernel is better computed alone, by a method that is
// much cheaper. It counts the stepper's steps, and trials begin after fixed numbers of them, so the decision about a
// motion does not depend on the others.
class TaylorWatch {
 public:
  // The equations of the motion, with its parameters, and the kernels of Taylor's expansions and of the rates.
  struct Equations {
    const Program* program = nullptr;
    std::shared_ptr<const KernelPlan> expansions, rates;
    const std::vector<double>* parameters = nullptr;
    const std::vector<long double>* wide_parameters = nullptr;
  };

  explicit TaylorWatch(double log_tolerance) : log_tolerance_(log_tolerance) {}
  // Begins with another motion, of which the stepper has made no step.
  void begin(const Stepper<double>& stepper);
  // The number of steps after which another_pays() has to be called, if they meet no kink.
  std::size_t steps_to_look(std::size_t steps) const;
  // Decides after a step.
  bool another_pays(Stepper<double>& taylor, const Equations& equations, long double end);

 private:
  struct Mark {
    long double t = 0;
    std::size_t steps = 0;
  };
  bool pays(Method method, const Mark& since, Stepper<double>& taylor, const Equations& equations,
            long double end) const;

  double log_tolerance_;
  std::size_t kinks_before_ = 0, next_kinks_ = kFirstKinks, next_stiff_ = kFirstStiff;
  std::optional<Mark> stiff_, kinky_;  // the start of the stretch on which the next trial is made
};

}  // namespace anholon
