// The models for a linearization: with signals as inputs, and at rest.
#pragma once
#include "linear/linear_model.h"

namespace anholon {

// Returns a model in which a constant u, 0 here, is added to each input of the file; B and D are derivatives by u. The
// formulas of inputs remain valid, so A is that of the motion that `simulate` computes; u acts also in the formulas of
// other inputs. The input of a servo constraint is an unknown, not a signal. An output is in the unit of its column.
std::shared_ptr<const Model> with_signals(const Model& model, Signals& signals);

// Adds a note on each input whose rates also move the model.
void note_rates(const Scenario& scenario, Signals& signals);

// Returns the model whose initial conditions are rest without accelerations, near the positions of the file.
std::shared_ptr<const Model> at_rest(const Model& model);

// Uses the positions of the choice, like those of the file, as the start of the search for an equilibrium: as given
// values they would not be an equilibrium. Throws Failure if the choice gives more than positions.
std::shared_ptr<const Model> searched_from(const Model& at_rest, StateChoice& choice);

// Returns the coordinates that occur in no condition of rest: neither in a constraint nor in a law with all velocities
// and accelerations zero. The search moves such a coordinate with the others, if the mass matrix couples them.
std::vector<std::size_t> without_influence(const Scenario& at_rest);

// Returns the model with the start values of these coordinates given, so that the search does not change them.
std::shared_ptr<const Model> held_at_start(const Model& at_rest, const std::vector<std::size_t>& coordinates);

// Replaces the message of a search without equilibrium, because the failed conditions are those of the search, not of
// the file. `states`: those of the model, whose values are searched for with the positions; the hint names them.
void say_no_rest(const std::vector<std::string>& states, Outcome& outcome);

}  // namespace anholon
