#include "ensemble/case_scenario.h"

#include <algorithm>

#include "model/exponents.h"

namespace anholon {

// Returns the place of a constraint among the multipliers of a model.
static std::optional<std::size_t> place_of(const std::string& constraint, const Model& model) {
  const std::vector<std::string>& names = model.names.multipliers;
  const auto at = std::find(names.begin(), names.end(), constraint);
  if (at == names.end()) return std::nullopt;
  return static_cast<std::size_t>(at - names.begin());
}

std::vector<std::size_t> varied_parameters(const EnsembleOptions& o) {
  std::vector<std::size_t> list;
  for (const Varied& v : o.varied)
    if (v.kind == Varied::Kind::parameter) list.push_back(v.index);
  return list;
}

std::vector<StateOverride> overrides_of(const EnsembleOptions& o, const EnsembleCase* numbers) {
  std::vector<StateOverride> list = o.state.overrides;
  for (std::size_t i = 0; i < o.varied.size(); ++i)
    if (const Varied& v = o.varied[i]; v.kind == Varied::Kind::initial)
      list.push_back({v.order, v.index, numbers ? numbers->values[i] : Rational(0)});
  return list;
}

SimulationOptions options_of_case(const EnsembleOptions& o, const EnsembleCase& numbers) {
  SimulationOptions options;
  options.state = o.state;
  options.state.overrides = overrides_of(o, &numbers);
  options.tolerance = o.tolerance;
  options.most_steps = o.most_steps;
  options.cancelled = o.cancelled;
  options.watches_floors = false;  // the notes of a case are not used
  return options;
}

Column formulas_in(Workspace& own, const Column& formulas, const EnsembleOptions& o,
                   const std::vector<std::size_t>& open) {
  Graph& g = own.graph();
  Column list;
  for (const Expr e : formulas) list.push_back(g.own(e));
  list = with_whole_exponents(*own.model, list, open);
  if (!o.switches || o.switches->multipliers == own.model->names.multipliers) return list;
  return substitute(list, [&](NodeId id) {
    const Node& n = g.node(id);
    if (n.kind != Kind::multiplier || n.index >= o.switches->multipliers.size()) return Expr{};
    const std::optional<std::size_t> place = place_of(o.switches->multipliers[n.index], *own.model);
    return place ? g.multiplier(static_cast<std::uint32_t>(*place), n.order) : g.zero();
  });
}

// Puts the constraints that hold in a case into its model. Fails if initial values are given to multipliers, which
// belong to the constraints of all cases.
static Outcome put_constraints(Model& model, const Switches& switches, const std::vector<StateOverride>& overrides) {
  switches.put(model);
  const bool given =
      std::any_of(overrides.begin(), overrides.end(), [](const StateOverride& o) { return o.multiplier; });
  if (!given || model.names.multipliers == switches.multipliers) return {};
  return {OutcomeKind::inconsistent, "initial values are given to multipliers, and this case has other constraints",
          "leave out these values, or those of parameters that switch a constraint with 'active'"};
}

static Outcome with_numbers(const Scenario& of_all, const EnsembleOptions& o, const EnsembleCase& numbers,
                            const std::optional<std::vector<std::size_t>>& open_parameters, Scenario& scenario) {
  const std::shared_ptr<Model> model = o.each_anew ? clone(*o.each_anew) : given_model(of_all);
  for (std::size_t i = 0; i < o.varied.size(); ++i)
    if (o.varied[i].kind == Varied::Kind::parameter)
      model->parameters[o.varied[i].index].value = model->graph->number(o.varied[i].unit.in_si(numbers.values[i]));
  StateChoice state = o.state;
  state.overrides = overrides_of(o, &numbers);
  if (o.switches)
    if (Outcome put = put_constraints(*model, *o.switches, state.overrides); !put.ok()) return put;
  state.open_parameters = open_parameters;
  return make_scenario(model, *of_all.system.form, state, scenario);
}

Outcome scenario_of_case(const Scenario& of_all, const EnsembleOptions& o, const EnsembleCase& numbers,
                         Scenario& scenario) {
  return with_numbers(of_all, o, numbers, std::vector<std::size_t>{}, scenario);
}

void scenario_of_cases(EnsembleOptions& o, Scenario& scenario) {
  constexpr std::size_t kMost = 64;
  const bool exponents_vary = !exponents_of(*given_model(scenario), varied_parameters(o)).empty();
  for (const bool whole_exponents : {false, true}) {
    if (whole_exponents) o.each_anew = given_model(scenario);
    if (whole_exponents && !exponents_vary) return;
    for (std::size_t k = 0; k < std::min(kMost, o.cases); ++k) {
      Scenario s;
      const std::optional<std::vector<std::size_t>> open =
          whole_exponents ? std::vector<std::size_t>{} : o.state.open_parameters;
      if (!with_numbers(scenario, o, o.numbers(k), open, s).ok()) continue;
      scenario = std::move(s);
      return;
    }
  }
}

}  // namespace anholon
