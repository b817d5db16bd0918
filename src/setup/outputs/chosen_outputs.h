// Outputs that are requested beside the model file: outputs of the file by their names, or formulas in its names.
#pragma once
#include "setup/scenario.h"

namespace anholon {

struct ChosenOutput {
  std::string name, formula;  // an empty formula: the name is also the formula
};

// Returns the model with these outputs alone; a vector gives one for each component. Throws Failure for an unknown name
// or a wrong formula. The model shares the graph of `open`, in which the formulas are built.
std::shared_ptr<const Model> with_outputs(const OpenModel& open, const std::vector<ChosenOutput>& outputs);

}  // namespace anholon
