#include "ensemble/cases/ensemble_plan.h"

#include <algorithm>

#include "ensemble/case_scenario.h"
#include "motion/representation.h"
#include "observe/watch.h"
#include "setup/outputs/output_tape.h"
#include "simulation/lost_value.h"

namespace anholon {

EnsemblePlan::EnsemblePlan(const Scenario& s, const EnsembleOptions& o)
    : of_all(s), options(o), scenario(s), parameters(scenario, o), lanes(o.cases, o.threads) {
  make();
  scenario.graph().freeze();
}

void EnsemblePlan::make() {
  Workspace& s = scenario;
  const EnsembleOptions& o = options;
  const Model& model = *s.model;
  const Graph& g = *model.graph;
  settings = {natural_logarithm(o.tolerance), o.order, o.most_steps, o.cancelled, o.kernel};
  plain = (o.method == Method::automatic || o.method == Method::taylor) && !s.routh && s.redundant.empty() &&
          s.elimination.pivots().empty() && !o.own_motion && !o.each_anew && model.bounds.empty() &&
          events_with_logarithms(model).empty();
  if (!plain) return;
  start.emplace(*s.mechanics);
  for (std::size_t j = 0; j < s.system.size(); ++j)
    for (int k = 0; k < s.structure.d[j]; ++k) entries.push_back(s.system.symbol_node(j, static_cast<unsigned>(k)));
  Column quadratures;
  for (const VaryingMass& m : model.masses) quadratures.push_back(m.value);
  reduced.first = quadratures.size();
  const Column formulas = formulas_in(s, o.reductions.formulas, o, varied_parameters(o));
  quadratures.insert(quadratures.end(), formulas.begin(), formulas.end());
  settings.known_from = 0, settings.known_to = reduced.first, settings.followed_to = quadratures.size();
  for (std::size_t i = 0; i < o.reductions.formulas.size(); ++i) {
    std::vector<Reduced::Function>& functions = reduced.functions.emplace_back();
    for (const NodeId id : reachable({&quadratures[reduced.first + i], 1}))
      if (const Node& n = g.node(id); n.kind == Kind::function && info(static_cast<Function>(n.index)).hides) {
        functions.push_back({{static_cast<Function>(n.index), 0}, quadratures.size()});
        quadratures.push_back({&s.graph(), g.summands(id)[0].node});
      }
  }
  watched = watched_series(s, quadratures.size());
  for (const Expr e : watched_formulas(model)) quadratures.push_back(e);
  for (const Event& e : model.events)
    sets.push_back(e.set.empty() ? std::nullopt : std::make_optional<SetByEvent>(s, e));
  const bool any_sets = std::any_of(sets.begin(), sets.end(), [](const auto& set) { return set.has_value(); });
  if (any_sets && !s.system.constraints.empty()) nearest.emplace(s, parameter_values<long double>(model));
  program = anholon::program(s.system, s.structure, quadratures);
  settings.measure = false;
  if (Start<long double> at; o.kernel && initial_state(s, o.state, at).ok()) {
    const std::vector<long double> numbers = parameter_values<long double>(model);
    const std::vector<double> state(at.state.begin(), at.state.end());
    const double t = static_cast<double>(at.t);
    const int order = o.order > 0 ? o.order : taylor_order(settings.log_tolerance);
    if (const auto derived = KernelPlan::make(std::make_shared<const Program>(*program), order - 1, numbers, t, state,
                                              Company::in_lanes)) {
      const std::vector<Representation> list = representations(
          {derived, s.structure, quadratures, numbers, t, state, s.mechanics.get()}, WritingEffort::long_motion);
      kernel = (watches_multipliers(model) ? cheapest_unmapped(list) : cheapest(list)).plan;
      if (o.method == Method::automatic && o.order == 0 && only_taylor(model, *program).empty())
        rates.emplace(std::make_shared<const Program>(*program), numbers, t, state);
    }
  }
  Column monitors;
  for (const Monitor& m : model.monitors) monitors.push_back(m.value);
  const Column ends = formulas_in(s, o.reductions.ends, o, varied_parameters(o));
  monitors.insert(monitors.end(), ends.begin(), ends.end());
  highest = largest_order(s, s.structure.d);
  stages = std::max(orders_beyond(s, s.structure.d), orders_needed(s, monitors));
  leading = stages > 0 || std::any_of(s.structure.d.begin(),
                                      s.structure.d.begin() + static_cast<std::ptrdiff_t>(s.system.coordinates),
                                      [](int d) { return d < 2; });
  if (monitors.empty()) return;
  outputs.emplace(Outputs{compile(OutputTape<Wider<double>>::put(s, monitors)), {}});
  for (const Input& in : outputs->tape.inputs) {
    const Node& n = g.node(in.symbol);
    const Outputs::Entry e{in.slot, s.system.variable(in.symbol), n.kind == Kind::time ? 0 : n.order};
    outputs->inputs.push_back(e);
    leading = leading || (e.variable && e.order >= s.structure.d[*e.variable]);
  }
}

}  // namespace anholon
