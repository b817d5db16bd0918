// Consistent initial data in stages: positions first, then velocities, then the further derivatives that the structure
// requires.
//
// Given values are kept. Missing ones follow from constraints and conditions by least change from the guess (0 by
// default) in the mass norm. Given values that miss a constraint by at most 1e-8 of its scale are taken for rounded
// numbers and corrected by least change; a larger residual is an error that names the constraint.
#pragma once
#include "base/outcome.h"
#include "structure/initial_problem.h"
#include "structure/structure.h"

namespace anholon {

// Computes positions and velocities from the constraints of orders 0 and 1 and the conditions on them.
template <Number N>
Outcome consistent_state(const InitialProblem<N>& problem, InitialState<N>& state);

// True if a condition of the initial data holds derivatives that follow from the state, of coordinates without inertia or
// beyond accelerations. `d`: the orders of the leading derivatives.
bool conditions_on_leading(const Model& model, const System& s, const std::vector<int>& d);

// True if the state holds more than positions and velocities, if there are conditions that contain accelerations or
// multipliers, or if the equations may have several solutions: complete_state is then needed.
bool needs_completion(const Mechanics& m, const System& s, const Structure& t);

// Completes a state of positions and velocities by all values that the structure of `s`, a system with multipliers,
// requires, and by the leading derivatives; conditions on accelerations and multipliers are solved together with the
// equations of motion.
template <Number N>
Outcome complete_state(const InitialProblem<N>& problem, const System& s, const Structure& t, InitialState<N>& state);

}  // namespace anholon
