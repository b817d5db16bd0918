// Notes on the formulas of a sweep whose values the equations do not determine.
#pragma once
#include "ensemble/reduce/reductions.h"
#include "setup/scenario.h"

namespace anholon {

// Returns notes on the formulas of the model and on the reductions that hold multipliers which share a force at the start
// of the scenario; none if no formula does.
std::vector<std::string> notes_of_formulas(const Scenario& s, const Reductions& reductions);

}  // namespace anholon
