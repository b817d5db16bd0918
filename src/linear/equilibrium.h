// The models of a linearization: with signals as inputs, and at rest.
#pragma once
#include "linear/linear_model.h"

namespace anholon {

// The inputs of the file with a constant added to each, 0 here: the symbol u by which B and D are derivatives. A
// formula of an input remains valid, so A is that of the motion that `simulate` computes. The input of a servo
// constraint is an unknown, not a signal.
std::shared_ptr<const Model> with_signals(const Model& model, Signals& signals);

// The model whose initial conditions are rest without accelerations, near the positions of the file.
std::shared_ptr<const Model> at_rest(const Model& model);

// Uses the positions of the choice as the start of the search for an equilibrium, like those of the file: held fixed,
// they would not be an equilibrium. Throws Failure if the choice gives more than positions.
std::shared_ptr<const Model> searched_from(const Model& at_rest, StateChoice& choice);

// If no equilibrium was found, the failed conditions are those of the search, not of the file: replaces the message.
void say_no_rest(Outcome& outcome);

}  // namespace anholon
