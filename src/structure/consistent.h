// Consistent initial data in stages: positions first, then velocities, then the further derivatives that the structure
// requires.
//
// Given values hold as given. Missing ones follow from constraints and conditions by least change from the guess (0 by
// default) in the mass norm. Given values that miss a constraint by at most 1e-8 of its scale are taken for rounded
// numbers and corrected by least change; a larger residual is an error that names the constraint.
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
  std::size_t coordinate;  // or the index of a constraint
  Rational value;
  bool multiplier = false;
};

// The expressions needed for positions and velocities, built once for many states: with a plan, `consistent_state`
// builds none if the overrides are those of the plan, with other values; many threads may then call it at the same
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
  const std::vector<Column>* mass = nullptr;  // the mass matrix, if the caller solves for many states
  const StartPlan* plan = nullptr;
  const InitialState<double>* near =
      // a solution of the same or of a similar problem: searches begin there, but measure changes from the guess
      nullptr;
};

// Positions and velocities, from the constraints of orders 0 and 1 and the conditions on them.
template <Number N>
Outcome consistent_state(const InitialProblem<N>& problem, InitialState<N>& state);

// True if the state holds more than positions and velocities, if there are conditions that contain accelerations or
// multipliers, or if the equations may have several solutions: complete_state is then needed.
bool needs_completion(const Mechanics& m, const System& s, const Structure& t);

// Completes a state of positions and velocities by all values that the structure of `s`, a system with multipliers,
// requires, and by the leading derivatives; conditions on accelerations and multipliers are solved together with the
// equations of motion.
template <Number N>
Outcome complete_state(const InitialProblem<N>& problem, const System& s, const Structure& t, InitialState<N>& state);

}  // namespace anholon
