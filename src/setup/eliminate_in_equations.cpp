// Eliminations for equations that are derived and compared, but not integrated.
#include "formulation/operators.h"
#include "setup/constraints_of_equations.h"
#include "setup/scenario.h"

namespace anholon {

// Adds accelerations, on which the pivots of constraints on accelerations depend; they follow from Routh's equations at
// the state. The state is unchanged if these have no solution there.
static void add_accelerations(const Model& model, const std::vector<StateOverride>& overrides,
                              InitialState<double>& state) {
  try {
    Scenario s;
    StateChoice choice;
    choice.overrides = overrides;
    const auto own = std::shared_ptr<const Model>(&model, [](const Model*) {});
    if (make_scenario(own, *find_formulation("routh"), choice, s).ok()) state = s.state;
  } catch (const Failure&) {
    // The refusal of a motion does not concern its equations.
  }
}

// Returns an elimination of the constraints among `all` that are independent.
static Elimination elimination_of(const Mechanics& m, const std::vector<std::size_t>& all, Unknowns unknowns,
                                  const std::vector<StateOverride>& overrides, const std::vector<std::size_t>& wanted,
                                  bool solve, unsigned order, const Model* starting = nullptr) {
  const Model& model = starting ? *starting : *m.model;
  Column es;
  for (const Parameter& p : model.parameters) es.push_back(p.value);
  const std::vector<double> parameters = evaluate_parameters<double>(*model.graph, es);
  InitialState<double> state;
  if (model.unknown_functions.empty()) {
    std::optional<Mechanics> of_start;
    if (starting) of_start = mechanics(*starting);
    const Mechanics* of = of_start ? &*of_start : &m;
    if (!consistent_state(InitialProblem<double>{of, parameters, overrides, {}}, state).ok()) state = {};
  }
  if (!state.q.empty() && highest_order(m) >= 2) add_accelerations(model, overrides, state);
  const auto at = std::make_shared<PointValues>(values_near(model, parameters, state));
  ConstraintsOfEquations constraints = constraints_of_equations(m, all, parameters, state);
  EliminationChoice choice = choose_elimination(m, constraints.taken, unknowns, wanted, *at);
  choice.left_out = std::move(constraints.left_out);
  choice.full_rank = constraints.full_rank;
  choice.solve = solve;
  choice.m = order;
  return Elimination(m, choice, at);
}

Elimination elimination_for(const Mechanics& m, Unknowns unknowns, const std::vector<StateOverride>& overrides,
                            const std::vector<std::size_t>& wanted, bool solve, unsigned order, const Model* starting) {
  if (unknowns != Unknowns::coordinates && unknowns != Unknowns::quasi_velocities) return Elimination::of_order(order);
  std::vector<std::size_t> all;
  for (std::size_t r = 0; r < m.phi.size(); ++r) all.push_back(r);
  return elimination_of(m, all, unknowns, overrides, wanted, solve, order, starting);
}

Elimination elimination_of_reactions(const Mechanics& m, const std::vector<StateOverride>& overrides,
                                     const std::vector<std::size_t>& wanted) {
  std::vector<std::size_t> ideal;
  for (std::size_t r = 0; r < m.phi.size(); ++r)
    if (!m.model->constraints[r].by) ideal.push_back(r);
  return elimination_of(m, ideal, Unknowns::coordinates, overrides, wanted, true, 0);
}

}  // namespace anholon
