// The schema of the rows of a run: the meaning of each column.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace anholon {

// Columns of one kind are computed in the same way from a state, so their errors have the same size.
enum class ColumnKind : std::uint8_t {
  time,
  coordinate,
  velocity,
  acceleration,
  higher_derivative,
  multiplier,
  multiplier_rate,
  input,
  state,
  reaction,
  monitor,
  event_time  // not a column: the kind of error of the times of events
};
// "coordinates", "velocities", …
const char* name(ColumnKind kind);

struct RunColumn {
  std::string name;  // x, x', lambda.blade, N.x, …
  ColumnKind kind = ColumnKind::time;
  std::size_t index = 0;  // of the coordinate, constraint, state or monitor in the model
  unsigned order = 0;     // of the derivative
  std::string unit;       // empty if the model gives none
};

std::vector<std::string> names_of(const std::vector<RunColumn>& columns);

}  // namespace anholon
