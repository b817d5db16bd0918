#include "result/columns.h"

namespace anholon {

const char* name(ColumnKind kind) {
  switch (kind) {
  case ColumnKind::time:
    return "time";
  case ColumnKind::coordinate:
    return "coordinates";
  case ColumnKind::velocity:
    return "velocities";
  case ColumnKind::acceleration:
    return "accelerations";
  case ColumnKind::higher_derivative:
    return "higher derivatives";
  case ColumnKind::multiplier:
    return "multipliers";
  case ColumnKind::multiplier_rate:
    return "rates of multipliers";
  case ColumnKind::input:
    return "inputs";
  case ColumnKind::state:
    return "states";
  case ColumnKind::reaction:
    return "reactions";
  case ColumnKind::monitor:
    return "monitors";
  case ColumnKind::event_time:
    return "times of events";
  }
  return "";
}

std::vector<std::string> names_of(const std::vector<RunColumn>& columns) {
  std::vector<std::string> names;
  names.reserve(columns.size());
  for (const RunColumn& c : columns) names.push_back(c.name);
  return names;
}

}  // namespace anholon
