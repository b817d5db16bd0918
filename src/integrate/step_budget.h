// Limits the steps that a motion may make. The motion is interrupted if the caller cancels it, at the step limit, and
// as soon as its end lies beyond that limit at its pace.
#pragma once
#include <algorithm>
#include <cmath>

#include "base/outcome.h"
#include "integrate/step_control.h"

namespace anholon {

// The outcome of a motion that may make no further step.
inline Outcome interrupted(bool cancelled) {
  return cancelled ? Outcome{OutcomeKind::interrupted, "interrupted", "what was computed is kept"}
                   : Outcome{OutcomeKind::interrupted, "the step limit is reached",
                             "allow more steps, or loosen the tolerance"};
}

// Fails if no further step may be made after so many.
inline Outcome may_step(const StepSettings& settings, std::size_t steps) {
  const bool cancelled = settings.cancelled && settings.cancelled();
  return cancelled || steps >= settings.most_steps ? interrupted(cancelled) : Outcome{};
}

// Judges whether the end of a motion lies beyond its step limit. Steps are short for a while after an impact, where a
// slip begins and where a motion starts, so no single step counts: the end is out of reach if the paces of the whole
// motion and of the last kWindow steps are both too slow, and the pace does not grow from window to window. If the end
// lies just beyond the limit, the motion may go on for longer than a hopeless one. A motion that was fast before is out
// of reach when many consecutive windows are hopeless: it chatters at a kink, or becomes too fast to follow.
class StepPaces {
 public:
  // The motion starts, or goes on, at the time t after so many steps.
  void begin(long double t, std::size_t steps) {
    now_ = before_ = last_ = {0, steps};
    slow_windows_ = 0;
    started_ = t;
    first_ = steps;
  }

  // The number of further steps for which out_of_reach() need not be called, if the end is not farther away than the
  // steps that are left.
  std::size_t steps_unjudged(std::size_t steps) const {
    const std::size_t made = steps - now_.steps;
    return made < kWindow ? kWindow - made : 0;
  }

  // Call it before each step from the time t, whose length would be `step`; `left` is the time to the end.
  bool out_of_reach(const StepSettings& settings, std::size_t steps, long double t, double step, double left) {
    const double passed = std::abs(static_cast<double>(t - started_));
    const std::size_t made = steps - first_;
    const double most = static_cast<double>(settings.most_steps - steps);
    if (steps - now_.steps >= kWindow) {
      before_ = last_, last_ = now_, now_ = {passed, steps};
      const double pace = of(last_, now_);
      const bool slow = std::abs(left) > kHopeless * most * pace && !(pace > kGrows * of(before_, last_));
      slow_windows_ = slow ? slow_windows_ + 1 : 0;
    }
    if (made < kStepsToJudge) return false;
    if (std::abs(left) <= step * most) return false;
    if (slow_windows_ >= kHopelessWindows) return true;
    const double pace = of(last_, now_), mean = passed / static_cast<double>(made);
    const double steps_ahead = std::abs(left) / std::max({pace, mean, step});
    if (!(steps_ahead > most) || pace > kGrows * of(before_, last_)) return false;
    return steps_ahead > kHopeless * most || made >= kStepsIfNear;
  }

 private:
  static constexpr std::size_t kWindow = 500, kStepsToJudge = 1000, kStepsIfNear = 20'000;
  static constexpr double kGrows = 1.25, kHopeless = 1000;
  static constexpr int kHopelessWindows = 100;
  struct Mark {
    double passed = 0;
    std::size_t steps = 0;
  };
  static double of(const Mark& a, const Mark& b) {
    return b.steps > a.steps ? (b.passed - a.passed) / static_cast<double>(b.steps - a.steps) : 0;
  }

  long double started_ = 0;
  std::size_t first_ = 0;
  int slow_windows_ = 0;  // consecutive slow windows up to the last one
  Mark before_, last_, now_;
};

inline Outcome end_out_of_reach(const StepSettings& settings, double step) {
  return {OutcomeKind::interrupted,
          "the end lies more than " + std::to_string(settings.most_steps) + " steps ahead: a step is about " +
              number_text(step, 2) + " long",
          "end the motion earlier, or take what is very fast or very stiff out of the model"};
}

}  // namespace anholon
