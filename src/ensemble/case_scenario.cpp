#include "ensemble/case_scenario.h"

#include <algorithm>

#include "model/exponents.h"

namespace anholon {

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

static Outcome with_numbers(const Scenario& of_all, const EnsembleOptions& o, const EnsembleCase& numbers,
                            const std::optional<std::vector<std::size_t>>& open_parameters, Scenario& scenario) {
  const std::shared_ptr<Model> model = given_model(of_all);
  for (std::size_t i = 0; i < o.varied.size(); ++i)
    if (o.varied[i].kind == Varied::Kind::parameter)
      model->parameters[o.varied[i].index].value = model->graph->number(numbers.values[i]);
  StateChoice state = o.state;
  state.overrides = overrides_of(o, &numbers);
  state.open_parameters = open_parameters;
  return make_scenario(model, *of_all.system.form, state, scenario);
}

Outcome scenario_of_case(const Scenario& of_all, const EnsembleOptions& o, const EnsembleCase& numbers,
                         Scenario& scenario) {
  return with_numbers(of_all, o, numbers, std::vector<std::size_t>{}, scenario);
}

Column formulas_in(Workspace& s, const Column& formulas, const std::vector<std::size_t>& open) {
  Column own;
  for (const Expr e : formulas) own.push_back(s.graph().own(e));
  return with_whole_exponents(*s.model, own, open);
}

Outcome scenario_of_cases(const EnsembleOptions& o, Scenario& scenario) {
  constexpr std::size_t kMost = 64;
  Outcome first;
  for (std::size_t k = 0; k < std::min(kMost, o.cases); ++k) {
    const EnsembleCase numbers = o.numbers(k);
    Scenario s;
    const Outcome outcome = with_numbers(scenario, o, numbers, o.state.open_parameters, s);
    if (k == 0) first = outcome;
    if (!outcome.ok()) continue;
    scenario = std::move(s);
    return {};
  }
  return first;
}

}  // namespace anholon
