#include "motion/start.h"

#include <algorithm>

#include "integrate/stepper.h"
#include "numeric/told_time.h"
#include "setup/outputs/redundant.h"

namespace anholon {

// Prepares, projects and solves at the start.
template <Number N>
static Outcome settle(Workspace& s, Expansion<N>& point) {
  const Start<double> start = start_of(s);
  point.load(start.t, {start.state.begin(), start.state.end()}, {start.leading.begin(), start.leading.end()});
  if (Outcome o = point.prepare(); !o.ok()) return o;
  if (Outcome o = point.project(); !o.ok()) return o;
  return point.solve();
}

Outcome regular_at_start(const Scenario& scenario) {
  using W = Wider<double>;
  Workspace s(scenario);
  const Program p = program(s.system, s.structure);
  const std::vector<W> parameters = parameter_values<W>(*s.model);
  Expansion<double> point(p, parameter_values<double>(*s.model), 1);
  const Outcome here = settle(s, point);
  if (here.kind == OutcomeKind::not_a_number) {
    // The equations may have a solution beside the start nevertheless.
    Stepper<double> stepper(p, point.parameters(), parameters, {});
    const Start<double> start = start_of(s);
    Outcome beside = stepper.start(start.t, {start.state.begin(), start.state.end()});
    tell_time(beside, start.t);
    return beside;
  }
  if (!here.ok() || s.redundant.empty()) return here;
  Expansion<W> wide(p, parameters, 1);
  if (Outcome o = settle(s, wide); !o.ok()) return o;
  std::vector<typename Redundant<W>::Miss> misses;
  if (Outcome o = Redundant<W>(s, parameters).hold(wide, true, misses); !o.ok()) return o;
  return follow_beside_start(s);
}

// Forms that eliminate lower the orders of their dependent coordinates, whose velocities follow from the constraints.
InitialState<double> start_as_in_rows(const Scenario& scenario) {
  const InitialState<double>& state = scenario.state;
  const std::vector<int>& d = scenario.structure.d;
  const auto end = d.begin() + static_cast<std::ptrdiff_t>(std::min(state.q.size(), d.size()));
  if (scenario.system.form->eliminates() || std::none_of(d.begin(), end, [](int order) { return order < 2; }))
    return state;
  Workspace s(scenario);
  const Program p = program(s.system, s.structure);
  Expansion<double> point(p, parameter_values<double>(*s.model), 1);
  if (!settle(s, point).ok() || !point.extend().ok()) return state;
  InitialState<double> shown = state;
  for (std::size_t a = 0; a < state.q.size(); ++a)
    for (int k = d[a]; k < 2; ++k) {
      (k == 0 ? shown.q : shown.qd)[a] = point.derivative(a, k);
      (k == 0 ? shown.q_origin : shown.qd_origin)[a] = Origin::derived;
    }
  return shown;
}

}  // namespace anholon
