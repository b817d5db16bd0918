// The choice of a method on the way (theory: methods): whether another one would come as far as Taylor's last steps did
// with fewer operations. It is found by a trial on a stretch of the motion itself.
#pragma once
#include <utility>

#include "motion/state_steppers.h"

namespace anholon {

// A first trial is made after so many kinks, or steps of Taylor's.
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

  // Taylor has made a step to t.
  void note_step(long double t);
  // Whether another method goes on towards `end` in place of Taylor; nullopt if Taylor does.
  std::optional<Turn> leave_taylor(long double end);
  // The same for BDF alone.
  std::optional<Turn> leave_for_bdf(long double end);
  // After nullopt: for how many steps the answer is known to be the same, at least one, at most `most`, as long as they
  // meet no kink.
  std::size_t stays_with_taylor(long double end, std::size_t most) const;
  // Another method has taken over where Taylor's motion is.
  void begin_other();
  // Whether the other method has cost more than Taylor would, over its last steps.
  bool slower_than_taylor(StateStepper& other);
  const Trials& trials() const { return trials_; }
  // What a looser tolerance would win, found in a long motion, once; empty if it is nothing, or was told before.
  std::string take_advice() { return std::exchange(advice_, {}); }

 private:
  bool pays(Method method, std::size_t steps, double factor, long double end);
  bool pays(StateStepper& trial, std::size_t steps, double factor, long double end);
  void look_for_advice(long double end);
  std::string percent() const;

  StateSteppers& steppers_;
  const Motion<double>& motion_;
  double log_tolerance_;
  std::vector<long double> times_;                                   // the ends of Taylor's last steps
  std::size_t next_kinks_ = kFirstKinks, next_stiff_ = kFirstStiff;  // after which a trial is made again
  double taylor_pace_ = 0;  // operations for a unit of time by Taylor where it was left
  double ratio_ = 0;        // operations of the last trial, relative to Taylor's
  // Where the present stretch of the other method began.
  struct Stretch {
    double t = 0, work = 0;
    std::size_t steps = 0;
  };
  Stretch stretch_;
  Trials trials_;
  std::string advice_;
};

// Whether a motion that many others accompany in the lanes of a kernel had better be made alone, by a method that is by far
// cheaper. Its steps are the stepper's, and trials begin after fixed numbers of them, so that every motion is judged
// alike in any company.
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
  // Another motion, whose first step the stepper has not made.
  void begin(const Stepper<double>& stepper);
  // For how many steps another_pays() needs not be asked, if they meet no kink.
  std::size_t steps_to_look(std::size_t steps) const;
  // Asked after a step.
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
  std::optional<Mark> stiff_, kinky_;  // where the stretch begins on which the next trial is made
};

}  // namespace anholon
