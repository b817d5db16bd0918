#include "structure/initial_problem.h"

#include <algorithm>

namespace anholon {

bool holds_higher(Expr e) {
  for (NodeId id : symbols({&e, 1}))
    if (is_higher(e.graph->node(id))) return true;
  return false;
}

static bool same_entry(const StateOverride& v, const Node& n) {
  return v.multiplier == (n.kind == Kind::multiplier) && v.order == n.order && v.coordinate == n.index;
}

bool overridden(const std::vector<StateOverride>& overrides, const Node& n) {
  return std::any_of(overrides.begin(), overrides.end(), [&](const StateOverride& v) { return same_entry(v, n); });
}

StageEquations conditions_of(const Model& model) {
  StageEquations list;
  for (const Condition& c : model.initial.conditions)
    list.push_back(
        {put_state_rates(model, put_masses(model, c.residual), 1), "condition \"" + c.text + "\"", c.span, true});
  return list;
}

Tape initial_values(const Model& model) {
  Column es = {model.initial.t};
  for (const StateVariable& z : model.states) es.push_back(z.initial);
  for (const std::vector<GivenValue>* list : {&model.initial.guess, &model.initial.given})
    for (const GivenValue& v : *list) es.push_back(v.value);
  return compile(es);
}

StartPlan::Stages planned(const Mechanics& m, const StageEquations& equations, const Column& unknowns, unsigned metric,
                          const std::vector<Column>* mass) {
  return equations.empty() ? nullptr : std::make_shared<StagePlan>(m, equations, unknowns, metric, mass);
}

static std::optional<Tape> rates_of_states(const Model& model) {
  if (model.states.empty()) return std::nullopt;
  Column es;
  for (const StateVariable& z : model.states) {
    const Expr rate = put_state_rates(model, put_masses(model, z.rate), 1);
    es.push_back(holds_higher(rate) ? model.graph->zero() : rate);
  }
  return compile(es);
}

StartPlan::StartPlan(const Mechanics& m, const std::vector<Column>* mass)
    : values(initial_values(*m.model)), state_rates(rates_of_states(*m.model)) {
  const Model& model = *m.model;
  std::vector<StageEquation> of_positions, of_velocities;
  for (const Constraint& c : model.constraints) {
    if (c.order > 1) continue;
    const Expr phi = put_state_rates(model, put_masses(model, c.phi), 1);
    if (holds_higher(phi)) continue;  // by the rate of a state: it constrains accelerations
    const std::string what = "constraint '" + c.name + "'";
    if (c.order == 0) {
      of_positions.push_back({phi, what, c.span});
      of_velocities.push_back({put_state_rates(model, total_derivative(phi), 1), "the derivative of " + what, c.span});
    } else {
      of_velocities.push_back({phi, what, c.span});
    }
  }
  for (const StageEquation& e : conditions_of(model))
    if (!holds_higher(e.residual)) (jet_order(e.residual) == 0 ? of_positions : of_velocities).push_back(e);
  constexpr unsigned kPositions = 1U, kVelocities = 2U;
  std::vector<Column> of_both;
  if (!mass && !(of_positions.empty() && of_velocities.empty())) mass = &(of_both = mass_matrix(m));
  positions = planned(m, of_positions, m.q, kPositions, mass);
  velocities = planned(m, of_velocities, m.qd, kVelocities, mass);
  std::vector<StageEquation> of_all;
  Column q_and_qd = m.q;
  if (std::any_of(of_velocities.begin(), of_velocities.end(), [](const StageEquation& e) { return e.condition; })) {
    of_all = of_positions;
    of_all.insert(of_all.end(), of_velocities.begin(), of_velocities.end());
    q_and_qd.insert(q_and_qd.end(), m.qd.begin(), m.qd.end());
    both = planned(m, of_all, q_and_qd, kPositions | kVelocities, mass);
  }
}

StartPlan StartPlan::copy() const {
  StartPlan p = *this;
  for (Stages* stages : {&p.positions, &p.velocities, &p.both})
    if (*stages) *stages = std::make_shared<StagePlan>(**stages);
  return p;
}

void for_each_expression(StartPlan& p, const ExprVisitor& f) {
  auto& [values, positions, velocities, both, state_rates] = p;
  static_cast<void>(values), static_cast<void>(state_rates);  // without handles
  for (StartPlan::Stages* stages : {&positions, &velocities, &both})
    if (*stages) for_each_expression(const_cast<StagePlan&>(**stages), f);
}

}  // namespace anholon
