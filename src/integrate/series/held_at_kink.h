// How a motion ends that a kink of a constraint holds or turns back.
#pragma once
#include <string>

#include "base/outcome.h"

namespace anholon {

// `constraint`: "the constraint 'wire'", or "a constraint" if the method cannot tell which.
inline Outcome held_at_kink(const std::string& constraint) {
  return {
      OutcomeKind::step_collapse,
      "the motion stays at a kink of " + constraint +
          ": the velocities before the kink miss it after the kink, and no equation holds the impulse that changes "
          "them",
      "put a smooth function in its place, such as sqrt(x^2 + 0.01^2) for abs(x), or let an event with stop = true end "
      "the motion at the kink"};
}

}  // namespace anholon
