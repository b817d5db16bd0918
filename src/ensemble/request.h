// What is asked of many motions, made into the options of their computation.
#pragma once
#include "ensemble/case.h"
#include "simulation/request.h"

namespace anholon {

// Fills end, times of rows, accuracy and method of the cases from what is asked and the file's settings; the file's
// times of rows are those of single motions. Checks that the reductions can be had. Throws Failure without a place.
void ask(const MotionSettings& asked, const Scenario& scenario, const Asker& asker, EnsembleOptions& options);

}  // namespace anholon
