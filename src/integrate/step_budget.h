// The steps that a motion may make. It is interrupted where the caller cancels it, at the step limit, and as soon as its
// end lies beyond that limit at the present pace.
#pragma once
#include "base/outcome.h"
#include "integrate/step_control.h"

namespace anholon {

// Another step may not be made: the caller has cancelled it, or the step limit is reached.
inline Outcome interrupted(bool cancelled) {
  return cancelled ? Outcome{OutcomeKind::interrupted, "interrupted", "what was computed is kept"}
                   : Outcome{OutcomeKind::interrupted, "the step limit is reached",
                             "allow more steps, or loosen the tolerance"};
}

// Not ok if another step may not be made after so many.
inline Outcome may_step(const StepSettings& settings, std::size_t steps) {
  const bool cancelled = settings.cancelled && settings.cancelled();
  return cancelled || steps >= settings.most_steps ? interrupted(cancelled) : Outcome{};
}

// The span of time that the steps made have passed, the length of the next one, the span that is left.
struct StepPace {
  double passed, step, left;
};

// Whether the end lies beyond the step limit, both at the present pace and at that of the whole motion so far.
inline bool out_of_reach(const StepSettings& settings, std::size_t steps, const StepPace& pace) {
  constexpr std::size_t kStepsToJudge = 1000;
  if (steps < kStepsToJudge) return false;
  const double most = static_cast<double>(settings.most_steps - steps);
  if (std::abs(pace.left) <= pace.step * most) return false;
  const double mean = std::abs(pace.passed) / static_cast<double>(steps);
  return std::abs(pace.left) > std::max(mean, pace.step) * most;
}

inline Outcome end_out_of_reach(const StepSettings& settings, double step) {
  return {OutcomeKind::interrupted,
          "the end lies more than " + std::to_string(settings.most_steps) + " steps ahead: a step is about " +
              number_text(step, 2) + " long",
          "end the motion earlier, or take what is very fast or very stiff out of the model"};
}

}  // namespace anholon
