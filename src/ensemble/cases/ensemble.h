// Computes many motions of one model, each with its own parameters, initial data and end.
//
// The model is read and put into equations once; cases differ by numbers in the same program. Every case ends with an
// outcome of its own and never stops the others. The bits of a case do not depend on the thread that computes it, nor
// on the cases before it.
//
// Memory is bounded by a window: results are delivered in the order of the cases, and a case is not begun if it is too
// far ahead of the first one that is not done.
#pragma once
#include "ensemble/case.h"
#include "ensemble/case_scenario.h"
#include "ensemble/columns.h"

namespace anholon {

// `scenario`: that of the model's own numbers, or of `scenario_of_cases`; threads only read it.
EnsembleReport ensemble(const Scenario& scenario, const EnsembleOptions& options, CaseSink& sink);

}  // namespace anholon
