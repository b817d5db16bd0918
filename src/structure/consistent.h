// Consistent initial data in stages: positions first, then velocities, then what the structure asks for beyond them.
//
// What the user gave holds as given; what is missing is found from the constraints and the conditions
// by least change from the guess (0 where there is none) in the mass norm. Where the given values
// miss a constraint by no more than 1e-8 of its scale they are taken as rounded numbers and
// corrected by least change; by more, it is an error that names the constraint.
#pragma once
#include <memory>
#include <optional>

#include "base/outcome.h"
#include "expr/handles.h"
#include "numeric/linear.h"
#include "structure/stage.h"
#include "structure/state.h"
#include "structure/structure.h"
#include "tape/tape.h"

namespace anholon {

// Values that override those of the model: q_a^(k), or lambda_r^(k).
struct StateOverride {
  unsigned order;
  std::size_t coordinate;  // or constraint
  Rational value;
  bool multiplier = false;
};

// All that positions and velocities need of the expressions, made once for many states: with a plan `consistent_state`
// builds none, as long as the overrides are those of the plan, with other values; many threads may then ask at the same
// time.
struct StartPlan {
  StartPlan(const Mechanics& m, const std::vector<StateOverride>& overrides, const std::vector<Column>* mass = nullptr);

  Tape values;  // t, the states, then guesses and given values
  using Stages = std::shared_ptr<const StagePlan>;
  Stages positions, velocities;            // null where there is nothing to solve
  bool kept = false;                       // made for overrides:
  Stages kept_positions, kept_velocities;  // without conditions that are only about what is overridden

  // The same plan with stages of its own; the handles are left as they are.
  StartPlan copy() const;
};
// The handles of a plan (expr/handles.h). REQUIRES: nobody else has its stages.
void for_each_expression(StartPlan& p, const ExprVisitor& f);

template <Number N>
struct InitialProblem {
  const Mechanics* mechanics;
  std::vector<N> parameters;
  std::vector<StateOverride> overrides;
  std::optional<Rational> t;
  const std::vector<Column>* mass = nullptr;  // the mass matrix, where the caller solves for many states
  const StartPlan* plan = nullptr;
  const InitialState<double>* near =
      nullptr;  // a solution of the same or of a similar problem: searches begin there, and measure changes as ever
};

// Positions and velocities, from the constraints of orders 0 and 1 and the conditions on them.
template <Number N>
Outcome consistent_state(const InitialProblem<N>& problem, InitialState<N>& state);

// True if the state holds more than positions and velocities, or if there are conditions that hold accelerations or
// multipliers, or if the equations may have several solutions: complete_state is then needed.
bool needs_completion(const Mechanics& m, const System& s, const Structure& t);

// Completes a state of positions and velocities by all that the structure of `s`, a system with multipliers, asks for,
// and by the leading derivatives; conditions on accelerations and multipliers are solved with the equations of motion.
template <Number N>
Outcome complete_state(const InitialProblem<N>& problem, const System& s, const Structure& t, InitialState<N>& state);

}  // namespace anholon
