// The problem of consistent initial data: the given values, and the compiled equations of positions and velocities.
#pragma once
#include <memory>
#include <optional>

#include "expr/handles.h"
#include "structure/stage.h"
#include "structure/state.h"
#include "tape/tape.h"

namespace anholon {

// Values that override those of the model: q_a^(k), or lambda_r^(k).
struct StateOverride {
  unsigned order;
  std::size_t coordinate;  // or the index of a constraint
  Rational value;
  bool multiplier = false;
  bool with_unit = false;  // written as "45 rad"
};

// The expressions needed for positions and velocities, built once for many states: with a plan, `consistent_state`
// builds none, and many threads may call it at the same time.
struct StartPlan {
  explicit StartPlan(const Mechanics& m, const std::vector<Column>* mass = nullptr);

  Tape values;  // t, the states, then guesses and given values
  using Stages = std::shared_ptr<const StagePlan>;
  Stages positions, velocities;  // null if there is nothing to solve
  // The stage of positions and velocities together, if there are conditions on velocities: positions may have to move
  // if no velocities fit.
  Stages both;
  // The rates of the model's states, if there are any: some belong to the state of the motion. A rate that holds more than
  // positions, velocities and states is a zero here; it follows from the equations.
  std::optional<Tape> state_rates;

  // Returns the same plan with stages of its own. The handles still refer to the old graph.
  StartPlan copy() const;
};
// The handles of a plan (expr/handles.h). REQUIRES: no other plan shares its stages.
void for_each_expression(StartPlan& p, const ExprVisitor& f);

template <Number N>
struct InitialProblem {
  const Mechanics* mechanics;
  std::vector<N> parameters;
  std::vector<StateOverride> overrides;
  std::optional<Rational> t;
  const std::vector<Column>* mass = nullptr;  // the mass matrix, if the caller solves for many states
  const StartPlan* plan = nullptr;
  // a solution of the same or of a similar problem: searches begin there, but measure changes from the guess
  const InitialState<double>* near = nullptr;
};

// True for q_a^(k) with k >= 2 and for multipliers: values beyond positions and velocities.
inline bool is_higher(const Node& n) { return n.kind == Kind::multiplier || (n.kind == Kind::jet && n.order > 1); }
bool holds_higher(Expr e);
bool overridden(const std::vector<StateOverride>& overrides, const Node& n);

using StageEquations = std::vector<StageEquation>;

StageEquations conditions_of(const Model& model);
// Returns the stage of these equations; null if there are no equations.
StartPlan::Stages planned(const Mechanics& m, const StageEquations& equations, const Column& unknowns, unsigned metric,
                          const std::vector<Column>* mass);
// Returns the tape of the numbers in the file: t, the states, then guesses and given values.
Tape initial_values(const Model& model);

}  // namespace anholon
