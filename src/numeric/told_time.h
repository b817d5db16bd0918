// The time of an outcome: its message tells it, and Outcome::t keeps it as a number.
#pragma once
#include <string>
#include <utility>

#include "base/outcome.h"
#include "numeric/number.h"

namespace anholon {

// Returns the time as a message tells it: " at t = 7.3".
inline std::string at_time(double t) { return " at t = " + number_text(t, 12); }

// Returns an outcome whose message tells t.
inline Outcome told(Outcome o, double t) {
  o.t = t;
  return o;
}

// Adds t to the message of a failure, unless the message tells a time.
inline void tell_time(Outcome& o, double t) {
  if (o.ok() || o.t) return;
  o.message += at_time(t);
  o.t = t;
}

}  // namespace anholon
