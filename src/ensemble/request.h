// What is asked of many motions, made into the options of their computation.
#pragma once
#include "ensemble/ensemble.h"
#include "simulation/request.h"

namespace anholon {

// Fills end, accuracy and method of the cases from the settings, which are complete. Throws Failure without a place.
void ask(const MotionSettings& settings, const Scenario& scenario, const Asker& asker, EnsembleOptions& options);

}  // namespace anholon
