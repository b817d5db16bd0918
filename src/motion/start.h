// The initial state as the motion leaves it.
#pragma once
#include "setup/scenario.h"

namespace anholon {

// Fails with `singular` if the accelerations are not determined at the initial state.
Outcome regular_at_start(const Scenario& scenario);

// Returns the initial state with the velocities of coordinates without inertia, and the positions of coordinates
// without derivatives, as they follow from the equations: the rows of a motion begin with them. Where the equations have
// no solution, these values are those of the scenario.
InitialState<double> start_as_in_rows(const Scenario& scenario);

}  // namespace anholon
