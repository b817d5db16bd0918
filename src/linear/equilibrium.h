// The models behind a linearization: with signals as inputs, and at rest.
#pragma once
#include "linear/linear_model.h"

namespace anholon {

// The inputs of the file with a constant added to each, 0 here: the symbol u by which B and D are derivatives. A formula
// of an input goes on to hold, so A is that of the motion that `simulate` computes. A servo constraint has its input as
// an unknown, not as a signal.
std::shared_ptr<const Model> with_signals(const Model& model, Signals& signals);

// The model whose initial conditions are rest without accelerations, near the positions of the file.
std::shared_ptr<const Model> at_rest(const Model& model);

// Takes the positions of the choice as the place where the search for an equilibrium begins, as those of the file are:
// held, they would be no equilibrium. Throws Failure if the choice gives more than positions.
std::shared_ptr<const Model> searched_from(const Model& at_rest, StateChoice& choice);

// Where no rest was found, the conditions that failed are not those of the file: says so.
void say_no_rest(Outcome& outcome);

}  // namespace anholon
