// The forces and torques on each body of a model: given forces with their places, and by Newton's law the reaction of
// all constraints.
#pragma once
#include "model/model.h"

namespace anholon {

// Resultant force and torque about the mass centre on each body, of the given forces, gravity and the reactive force.
// Potentials, dissipation and generalized forces have no place and are not among them.
struct Load {
  Vector force, torque;
};
std::vector<Load> given_loads(const Model& model);
std::vector<Load> reactive_loads(const Model& model);

// Return the total constraint reaction on each body, or on body b: m a - F - mdot u - fictitious forces, and its torque
// about the mass centre (theory: certificate). Masses are substituted; the result contains accelerations.
std::vector<Load> reactions(const Model& model);
Load reaction(const Model& model, std::size_t b);

}  // namespace anholon
