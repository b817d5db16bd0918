// Whether a motion can leave its initial state.
#pragma once
#include "setup/scenario.h"

namespace anholon {

// Singular if the accelerations are not determined at the initial state.
Outcome regular_at_start(const Scenario& scenario);

}  // namespace anholon
