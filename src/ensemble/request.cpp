#include "ensemble/request.h"

#include "base/diagnostic.h"

namespace anholon {

void ask(const MotionSettings& settings, const Scenario& s, const Asker& asker, EnsembleOptions& o) {
  if (!settings.to && settings.at.empty())
    throw Failure({}, "no end time", asker.example("to", "10") + ", or [simulate] to = 10 in the model file");
  o.to = settings.to ? *settings.to : settings.at.back().value;
  o.tolerance = tolerance(settings, Precision::real, asker);
  o.order = settings.order.value_or(0);
  o.estimate = error_estimate(settings);
  o.most_steps = most_steps(settings);
  SimulationOptions one;
  one.tolerance = o.tolerance;
  one.order = o.order;
  o.method = method(settings, s, one, asker);
  must_go_forwards(s, Rational(s.state.t), o.to);
}

}  // namespace anholon
