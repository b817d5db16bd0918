// The choice of a method on the way (theory: methods): whether another one would come as far as Taylor's last steps did
// with fewer operations. It is found by a trial on a stretch of the motion itself.
#pragma once
#include "motion/state_steppers.h"

namespace anholon {

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

 private:
  bool pays(Method method, std::size_t steps, double factor, long double end);
  std::string percent() const;

  StateSteppers& steppers_;
  const Motion<double>& motion_;
  double log_tolerance_;
  std::vector<long double> times_;                    // the ends of Taylor's last steps
  std::size_t next_kinks_ = 128, next_stiff_ = 2048;  // kinks, steps of Taylor's after which a trial is made again
  double taylor_pace_ = 0;                            // operations for a unit of time by Taylor where it was left
  double ratio_ = 0;                                  // operations of the last trial, relative to Taylor's
  // Where the present stretch of the other method began.
  struct Stretch {
    double t = 0, work = 0;
    std::size_t steps = 0;
  };
  Stretch stretch_;
  Trials trials_;
};

}  // namespace anholon
