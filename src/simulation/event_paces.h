// Finds events that accumulate: an event that comes at ever shorter intervals happens infinitely often before some
// moment, beyond which nothing is computed.
#pragma once
#include <string>
#include <vector>

#include "motion/motion.h"

namespace anholon {

template <class W>
class EventPaces {
 public:
  explicit EventPaces(const std::vector<Event>& events) : events_(events), paces_(events.size()) {}

  // Notes an occurrence in a motion of this duration. The outcome ends the motion if the event accumulates.
  Outcome see(const Occurrence<W>& o, const W& duration) {
    constexpr int kShrinking = 3;
    constexpr double kNoTime = 1e-8;
    const Event& e = events_[o.event];
    if (e.set.empty()) return {};
    Pace& p = paces_[o.event];
    const W interval = abs(W(o.t - p.last));
    p.shrinking = p.times > 1 && interval < p.interval ? p.shrinking + 1 : 0;
    p.interval = interval;
    p.last = o.t;
    ++p.times;
    if (p.shrinking < kShrinking || interval > W(kNoTime) * abs(duration)) return {};
    return {OutcomeKind::step_collapse,
            "events accumulate: '" + e.name + "' fired " + std::to_string(p.times) +
                " times, sooner and sooner, the last time after " + number_text(to_double(interval), 2),
            "let an event end the motion (stop = true), or change a mode, when what it resets has become small"};
  }

 private:
  struct Pace {
    std::size_t times = 0;
    int shrinking = 0;  // the number of times in a row that the interval has become shorter
    W last{0}, interval{0};
  };
  const std::vector<Event>& events_;
  std::vector<Pace> paces_;  // by event
};

}  // namespace anholon
