// The columns of the results of an ensemble: coordinates, velocities, the model's states, outputs.
#pragma once
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "model/model.h"
#include "result/columns.h"

namespace anholon {

// The value of a column that a run does not have.
inline constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
std::vector<std::string> ensemble_columns(const Model& model);
// The places of these columns among the columns of a row; nullopt for a velocity that the row does not have, because no
// coordinate is solved for by more than its value. Further monitors, such as those of contacts, are last.
std::vector<std::optional<std::size_t>> ensemble_places(const Model& model, const std::vector<RunColumn>& columns);

}  // namespace anholon
