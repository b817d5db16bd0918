// When a support begins to pull, located on the Taylor polynomials.
#pragma once
#include <optional>

#include "observe/options.h"
#include "observe/supports.h"

namespace anholon {

// By a motion of its own with an event where the force of the support passes zero downwards, up to the time `until`;
// the motion that is reported stays as it is. nullopt if that motion has no such event.
std::optional<double> first_pull(const Scenario& s, const SimulationOptions& o, const Support& support, double until);

}  // namespace anholon
