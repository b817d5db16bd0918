// Outputs that somebody asks for beside the model file: its own by their names, or formulas in its names.
#pragma once
#include "setup/scenario.h"

namespace anholon {

struct ChosenOutput {
  std::string name, formula;  // an empty formula: the name is also the formula
};

// The model with these outputs alone; a vector gives one for each component. Throws Failure for a name or formula that the
// model does not have. The model has a graph of its own, of which the names are.
std::shared_ptr<const Model> with_outputs(const OpenModel& open, const std::vector<ChosenOutput>& outputs);

}  // namespace anholon
