// The models of a linearization: with signals as inputs, and at rest.
#pragma once
#include "linear/linear_model.h"

namespace anholon {

// The inputs of the file with a constant added to each, 0 here: the symbol u by which B and D are derivatives. A
// formula of an input remains valid, so A is that of the motion that `simulate` computes; u acts in the formulas of
// other inputs, too. The input of a servo constraint is an unknown, not a signal. An output is in the unit of its
// column.
std::shared_ptr<const Model> with_signals(const Model& model, Signals& signals);

// Adds a note on each input by whose rates the model is moved, too.
void note_rates(const Scenario& scenario, Signals& signals);

// The model whose initial conditions are rest without accelerations, near the positions of the file.
std::shared_ptr<const Model> at_rest(const Model& model);

// Uses the positions of the choice as the start of the search for an equilibrium, like those of the file: held fixed,
// they would not be an equilibrium. Throws Failure if the choice gives more than positions.
std::shared_ptr<const Model> searched_from(const Model& at_rest, StateChoice& choice);

// The coordinates that occur in no condition of rest: neither in a constraint nor in a law with all velocities and
// accelerations zero. The search moves such a coordinate with the others, if the mass matrix couples them.
std::vector<std::size_t> without_influence(const Scenario& at_rest);

// The model with the start values of these coordinates given, so that the search leaves them as they are.
std::shared_ptr<const Model> held_at_start(const Model& at_rest, const std::vector<std::size_t>& coordinates);

// If no equilibrium was found, the failed conditions are those of the search, not of the file: replaces the message.
// `states`: those of the model, which keep their initial values in the search; the hint says so.
void say_no_rest(const std::vector<std::string>& states, Outcome& outcome);

}  // namespace anholon
