// The states of [state] at an equilibrium: those that influence the motion have values at which they rest, too.
#pragma once
#include "model/model.h"

namespace anholon {

// Returns the model with initial values of its states, and guesses of its positions, at which all laws of rest hold:
// the equations of motion and the constraints without velocities and accelerations, and a rate of zero of each state
// that influences them. The search begins at the initial values of the file, and changes positions and states as little
// as these laws allow. Returns nullptr if no state has influence, or if no such values are found.
//
// `at_rest`: the model whose equilibrium is searched for (equilibrium.h: at_rest). `digits`: those of the values.
std::shared_ptr<const Model> with_states_at_rest(const Model& at_rest, int digits);

}  // namespace anholon
