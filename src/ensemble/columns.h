// The columns of the results of an ensemble: coordinates, velocities, the model's states, outputs.
#pragma once
#include <string>
#include <vector>

#include "model/model.h"
#include "result/columns.h"

namespace anholon {

std::vector<std::string> ensemble_columns(const Model& model);
// Their places among the columns of a row.
std::vector<std::size_t> ensemble_places(const std::vector<RunColumn>& columns);

}  // namespace anholon
