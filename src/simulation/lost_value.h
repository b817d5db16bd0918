// Finds where the formula of an event loses its value within a step and its series do not show it: a^b with b made of
// parameters is exp(b*log(a)), and if b is 2, its series are those of a^2 as long as a > 0.
#pragma once
#include <algorithm>
#include <cmath>

#include "motion/course.h"
#include "numeric/told_time.h"
#include "simulation/followed_value.h"

namespace anholon {

// Returns the events whose formulas contain a logarithm.
inline std::vector<std::size_t> events_with_logarithms(const Model& model) {
  std::vector<std::size_t> list;
  for (std::size_t i = 0; i < model.events.size(); ++i) {
    const Expr& when = model.events[i].when;
    const std::vector<NodeId> in = reachable({&when, 1});
    const auto is_log = [&](NodeId id) {
      const Node& n = when.graph->node(id);
      return n.kind == Kind::function && static_cast<Function>(n.index) == Function::log;
    };
    if (std::any_of(in.begin(), in.end(), is_log)) list.push_back(i);
  }
  return list;
}

template <Number N>
class LostValues {
 public:
  using W = Wider<N>;
  struct Lost {
    W t{0};                            // the last time of the step with a value
    std::optional<std::size_t> event;  // nullopt if no event loses its value
  };

  explicit LostValues(const Model& model) : events_(events_with_logarithms(model)) {}
  bool any() const { return !events_.empty(); }

  // Returns the first loss in the last step before `end`. `first`: the first event among the quadratures.
  Lost in_last_step(const Course<N>& course, std::size_t first, const W& end) const {
    Lost lost{end, {}};
    if (events_.empty() || !course.by_taylor() || course.taylor().stepper().one_sided()) return lost;
    const Motion<N>& motion = course.taylor();
    const Stepper<N>& stepper = motion.stepper();
    Expansion<W> point(motion.program(), motion.parameters(), 1);
    for (const std::size_t event : events_) {
      const auto has_value = [&](const W& t) {
        const auto [value, made_of] = value_of_quadrature(stepper, t, first + event, point);
        return std::isfinite(value) || made_of < 0;
      };
      if (has_value(lost.t)) continue;
      W low = stepper.before(), high = lost.t;
      for (int k = 0; k < 200; ++k) {
        const W middle = low + (high - low) * W(0.5);
        if (middle == low || middle == high) break;
        (has_value(middle) ? low : high) = middle;
      }
      lost = {low, event};
    }
    return lost;
  }

  static Outcome outcome(const Model& model, const Lost& lost) {
    const double t = to_double(lost.t);
    return told({OutcomeKind::not_a_number,
                 "the formula of the event '" + model.events[*lost.event].name +
                     "' has no value from t = " + number_text(t, 12) + " on",
                 kEventWithoutValue},
                t);
  }

 private:
  std::vector<std::size_t> events_;
};

}  // namespace anholon
