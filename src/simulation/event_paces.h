// Finds events that accumulate: an event that comes at ever shorter intervals happens infinitely often before some
// moment, beyond which nothing is computed.
#pragma once
#include <string>
#include <vector>

#include "motion/motion.h"

namespace anholon {

// True if one of the events that fired ends the motion.
template <class N>
bool any_stops(const std::vector<Event>& events, const std::vector<Fired<N>>& fired) {
  return std::any_of(fired.begin(), fired.end(),
                     [&](const Fired<N>& f) { return f.series < events.size() && events[f.series].stop; });
}

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

  // Notes the events that fired in a step from `begin` on. Returns the first outcome that ends the motion.
  template <class N>
  Outcome see(const std::vector<Fired<N>>& fired, const W& begin, const W& duration) {
    Outcome first;
    for (const Fired<N>& f : fired) {
      if (f.series >= events_.size()) continue;
      const Outcome o = see({f.series, begin + convert<W>(f.where), {}, W(0)}, duration);
      if (first.ok()) first = o;
    }
    return first;
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
