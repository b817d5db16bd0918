// The options of a run that motions with contacts, or with constraints that are switched, do not know.
#pragma once
#include "simulation/request.h"

namespace anholon {

// Throws Failure if there is one. switches: whether constraints are switched.
void refuse_options(const SimulationOptions& o, const Scenario& s, bool switches);

}  // namespace anholon
