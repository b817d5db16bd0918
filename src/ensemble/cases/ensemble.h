// Many motions of one model, each with parameters, initial data and an end of its own.
//
// The model is read and put into equations once; a case has other numbers in the same program. Every case ends with an
// outcome of its own and never stops the others. Which thread computes a case, and after which others, has no influence
// on its bits.
//
// Memory is bounded by a window: results are given in the order of the cases, and no case is begun that lies further
// ahead of the first one that is not done.
#pragma once
#include "ensemble/case.h"
#include "ensemble/case_scenario.h"
#include "ensemble/columns.h"

namespace anholon {

// The scenario is that of the model's own numbers, or of `scenario_of_cases`; threads only read it.
EnsembleReport ensemble(const Scenario& scenario, const EnsembleOptions& options, CaseSink& sink);

}  // namespace anholon
