#include "linear/equilibrium.h"

#include <algorithm>

#include "formula/units.h"
#include "setup/inputs.h"
#include "structure/consistent.h"

namespace anholon {

// Returns the output in the unit of its column.
static Expr in_its_unit(const OutputQuantity& output, Expr value) {
  const std::optional<Unit> unit = output.unit.empty() ? std::nullopt : read_unit(output.unit);
  if (!unit) return value;
  Graph& g = *value.graph;
  return value * g.number(Rational(1 / unit->factor)) * pow(g.pi(), Rational(-unit->pi));
}

// Lists the inputs that the formula of an input contains: ", nor what 'ref' does by it".
static std::string others_in(const Model& model, const Control& control) {
  std::string list;
  std::vector<const Control*> seen{&control};
  for (std::size_t k = 0; k < seen.size(); ++k) {
    if (!seen[k]->open.graph) continue;
    for (const NodeId id : symbols({&seen[k]->open, 1})) {
      const Node& n = model.graph->node(id);
      if (n.kind != Kind::control) continue;
      const Control* other = &model.controls[n.index];
      if (!other->value || std::find(seen.begin(), seen.end(), other) != seen.end()) continue;
      seen.push_back(other);
      list += (list.empty() ? ", nor what '" : ", '") + other->name + "'";
    }
  }
  return list.empty() ? "" : list + " does by it";
}

std::shared_ptr<const Model> with_signals(const Model& model, Signals& signals) {
  auto m = std::make_shared<Model>(model);
  Graph& g = *m->graph;
  for (Control& control : m->controls) {
    if (!control.value || control.constraint) continue;
    const Expr u = g.parameter(static_cast<std::uint32_t>(m->parameters.size()));
    m->parameters.push_back({control.name, g.zero(), "", control.span});
    // The formulas of other inputs also contain the sum.
    Expr& formula = control.open.graph ? control.open : *control.value;
    formula = formula + u;
    signals.inputs.push_back(control.name);
    signals.u.push_back(u);
    if (!control.put_into.empty())
      signals.notes.push_back("the formula of the input '" + control.name + "' is put into " + control.put_into +
                              ": B and D do not hold what it does there" + others_in(model, control));
  }
  put_inputs_into_inputs(*m, {});
  put_inputs(*m);
  for (const OutputQuantity& output : m->outputs)
    for (std::size_t i = 0; i < output.values.size(); ++i) {
      signals.outputs.push_back(output.name + (output.values.size() == 1 ? "" : std::string(".") + "xyz"[i]));
      signals.y.push_back(in_its_unit(output, output.values[i]));
    }
  return m;
}

void note_rates(const Scenario& scenario, Signals& signals) {
  for (const std::string& input : inputs_with_rates(scenario))
    signals.notes.push_back("the rate of the input '" + input +
                            "' acts as well, as of one that stands in a position: it would be an input, too, and B and "
                            "D do not hold what it does");
}

// Returns the initial positions if conditions determine some; empty if the conditions have no solution.
static std::vector<GivenValue> positions_by_conditions(const Model& model) {
  if (model.initial.conditions.empty() || !model.unknown_functions.empty()) return {};
  const std::shared_ptr<Model> own = clone(model);
  const Mechanics m = mechanics(*own);
  const InitialProblem<double> problem{&m, parameter_values<double>(*own), {}, std::nullopt};
  InitialState<double> state;
  if (!consistent_state(problem, state).ok()) return {};
  Graph& g = *model.graph;
  std::vector<GivenValue> list;
  for (std::size_t a = 0; a < state.q.size(); ++a)
    if (is_finite(state.q[a]))
      list.push_back({g.jet(static_cast<std::uint32_t>(a), 0), g.number(Rational(state.q[a])), {}});
  return list;
}

std::shared_ptr<const Model> at_rest(const Model& model) {
  auto m = std::make_shared<Model>(model);
  Graph& g = *m->graph;
  InitialData data;
  data.t = model.initial.t;
  for (const std::vector<GivenValue>* list : {&model.initial.guess, &model.initial.given})
    for (const GivenValue& v : *list)
      if (const Node& n = g.node(v.symbol.id); n.kind == Kind::jet && n.order == 0) data.guess.push_back(v);
  if (std::vector<GivenValue> found = positions_by_conditions(model); !found.empty()) data.guess = std::move(found);
  for (std::size_t a = 0; a < m->coordinates.size(); ++a) {
    const auto index = static_cast<std::uint32_t>(a);
    data.given.push_back({g.jet(index, 1), g.zero(), {}});
    data.conditions.push_back({g.jet(index, 2), m->coordinates[a].name + "'' = 0", {}});
  }
  m->initial = std::move(data);
  return m;
}

std::shared_ptr<const Model> searched_from(const Model& at_rest, StateChoice& choice) {
  auto m = std::make_shared<Model>(at_rest);
  Graph& g = *m->graph;
  for (const StateOverride& given : choice.overrides) {
    if (given.multiplier || given.order > 0)
      throw Failure({}, "an equilibrium is at rest: only positions can be given, by --q",
                    "leave out the others, or linearize about the state that is given: --about state");
    const Expr q = g.jet(static_cast<std::uint32_t>(given.coordinate), 0);
    std::erase_if(m->initial.guess, [&](const GivenValue& v) { return v.symbol == q; });
    m->initial.guess.push_back({q, g.number(given.value), {}});
  }
  choice.overrides.clear();
  return m;
}

std::vector<std::size_t> without_influence(const Scenario& scenario) {
  Workspace s(scenario);
  Graph& g = s.graph();
  const System& system = s.routh ? *s.routh : s.system;
  Column conditions = system.equations;
  conditions.insert(conditions.end(), s.mechanics->phi.begin(), s.mechanics->phi.end());
  try {
    conditions = substitute(conditions, [&](NodeId id) {
      const Node& n = g.node(id);
      return n.kind == Kind::jet && n.order > 0 ? g.zero() : Expr{};
    });
  } catch (const Failure&) {
    // A formula divides by a velocity, so everything in it may have influence.
  }
  const std::vector<NodeId> met = symbols(conditions);
  std::vector<std::size_t> list;
  for (std::size_t a = 0; a < s.mechanics->q.size(); ++a)
    if (std::find(met.begin(), met.end(), s.mechanics->q[a].id) == met.end()) list.push_back(a);
  return list;
}

std::shared_ptr<const Model> held_at_start(const Model& at_rest, const std::vector<std::size_t>& coordinates) {
  auto m = std::make_shared<Model>(at_rest);
  InitialData& data = m->initial;
  for (std::size_t a : coordinates) {
    const Expr q = m->graph->jet(static_cast<std::uint32_t>(a), 0);
    GivenValue start{q, m->graph->zero(), {}};
    for (const GivenValue& v : data.guess)
      if (v.symbol == q) start = v;
    std::erase_if(data.guess, [&](const GivenValue& v) { return v.symbol == q; });
    data.given.push_back(start);
  }
  return m;
}

void say_no_rest(const std::vector<std::string>& states, Outcome& o) {
  if (o.kind != OutcomeKind::inconsistent) return;
  o.message = "no equilibrium was found near the initial positions";
  o.hint = "there may be none, also where a rounded number stands for a formula; the search begins at other positions "
           "by --q or [initial]";
  if (states.empty()) return;
  std::string names;
  for (const std::string& z : states) names += (names.empty() ? "" : ", ") + z;
  o.hint += "; so do the values of " + names + " of [state]";
}

}  // namespace anholon
