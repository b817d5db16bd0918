// Finds coordinates whose elimination makes a motion steady.
#pragma once
#include "linear/linear_point.h"

namespace anholon {

// A vehicle that turns steadily is steady in its speed and its rate of turn, not in x' and y'. The function searches
// coordinates on which no equation depends and without whose velocities the motion through the state is steady. Each
// choice is tried: the linear model is made and examined anew. Returns an empty list if no choice succeeds. REQUIRES:
// the point is settled, and its motion unsteady in the velocities that were chosen there.
std::vector<std::size_t> steady_elimination(const VariedEquations& equations, const std::vector<Multi>& parameters,
                                            const LinearPoint& point);

}  // namespace anholon
