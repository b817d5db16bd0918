#include "ensemble/request.h"

#include <algorithm>

#include "base/diagnostic.h"

namespace anholon {

namespace {

// Sets the times of rows, which lie between the start and the end of a motion. Cases share both.
void set_times(const MotionSettings& asked, const Scenario& s, const Asker& asker, EnsembleOptions& o) {
  for (const WrittenTime& t : asked.at)
    if (o.at.empty() || o.at.back() != t.value) o.at.push_back(t.value);
  if (o.at.empty()) return;
  const Rational start = o.state.t                       ? *o.state.t
                         : is_number(s.model->initial.t) ? number_value(s.model->initial.t)
                                                         : Rational(s.state.t);
  if (!asked.to) o.to = o.at.back() > start ? o.at.back() : o.at.front();
  must_lie_between(o.at, start, o.to, asker);
}

// Throws unless the reductions can be computed: they follow Taylor's polynomials, which have derivatives up to those
// that are solved for.
void must_be_had(const Reductions& reductions, const Scenario& s, const Asker& asker, Method method) {
  if (reductions.list.empty()) return;
  if (method != Method::automatic && method != Method::taylor)
    throw Failure({}, asker.called("reduce") + " follows the polynomials of Taylor's method",
                  "leave out " + asker.called("method") + ", or use " + asker.example("method", "taylor"));
  const bool known = !s.structure.d.empty();  // false if no case has a start
  for (const Reduction& r : reductions.list) {
    if (r.of_event() || !known) continue;
    const std::vector<Expr>& among = r.kind == Reduction::Kind::last ? reductions.ends : reductions.formulas;
    if (const Expr e = among[r.of]; orders_needed(s, {&e, 1}) > 0)
      throw Failure({}, "'" + r.name + "' holds derivatives beyond those that are solved for",
                    "write the formula with lower derivatives");
  }
}

}  // namespace

void ask(const MotionSettings& asked, const Scenario& s, const Asker& asker, EnsembleOptions& o) {
  const MotionSettings settings = merged(asked, s.model->simulate);
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
  set_times(asked, s, asker, o);
  must_be_had(o.reductions, s, asker, o.method);
  must_go_forwards(s, Rational(s.state.t), o.to);
}

}  // namespace anholon
