// The columns of the results of an ensemble: coordinates, velocities, the model's states, outputs.
#pragma once
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "model/model.h"
#include "result/columns.h"

namespace anholon {

// Of a column that a run does not have.
inline constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
std::vector<std::string> ensemble_columns(const Model& model);
// Their places among the columns of a row; nullopt for a velocity that the row does not have, as where no coordinate is
// solved for by more than its value. Monitors that follow those of the model, as of contacts, are last.
std::vector<std::optional<std::size_t>> ensemble_places(const Model& model, const std::vector<RunColumn>& columns);

}  // namespace anholon
