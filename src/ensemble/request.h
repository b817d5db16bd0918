// Makes the settings of many motions into the options of their computation.
#pragma once
#include "ensemble/case.h"
#include "simulation/request.h"

namespace anholon {

// Fills end, times of rows, accuracy and method of the cases from the given settings and the file's settings; the
// file's times of rows are for single motions only. Checks that the reductions can be computed. Throws Failure without
// a place.
void ask(const MotionSettings& asked, const Scenario& scenario, const Asker& asker, EnsembleOptions& options);

}  // namespace anholon
