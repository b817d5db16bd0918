// Decides whether a motion can leave its initial state.
#pragma once
#include "setup/scenario.h"

namespace anholon {

// Fails with `singular` if the accelerations are not determined at the initial state.
Outcome regular_at_start(const Scenario& scenario);

}  // namespace anholon
