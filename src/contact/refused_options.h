// The options of a run that motions with contacts, or with switched constraints, do not support.
#pragma once
#include "simulation/request.h"

namespace anholon {

// Throws Failure if there is one. `switches`: constraints are switched.
void refuse_options(const SimulationOptions& o, const Scenario& s, bool switches);

}  // namespace anholon
