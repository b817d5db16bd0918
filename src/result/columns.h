// The schema of the rows of a run: what each column holds.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace anholon {

// Columns of one kind are computed in the same way from a state, so their errors are of one size.
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
  event_time  // of no column of a row: the kind of error of the moments of events
};
// "coordinates", "velocities", …
const char* name(ColumnKind kind);

struct RunColumn {
  std::string name;  // x, x', lambda.blade, N.x, …
  ColumnKind kind = ColumnKind::time;
  std::size_t index = 0;  // of the coordinate, constraint, state or monitor in the model
  unsigned order = 0;     // of the derivative
  std::string unit;       // empty where the model names none
};

std::vector<std::string> names_of(const std::vector<RunColumn>& columns);

}  // namespace anholon
