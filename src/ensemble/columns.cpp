#include "ensemble/columns.h"

#include "print/print_names.h"

namespace anholon {

std::vector<std::string> ensemble_columns(const Model& model) {
  std::vector<std::string> names;
  for (const unsigned k : {0U, 1U})
    for (const Coordinate& c : model.coordinates) names.push_back(derivative_name(c.name, k, Format::text));
  for (const StateVariable& z : model.states) names.push_back(z.name);
  for (const Monitor& m : model.monitors) names.push_back(m.name);
  return names;
}

std::vector<std::size_t> ensemble_places(const std::vector<RunColumn>& columns) {
  std::vector<std::size_t> places;
  for (const ColumnKind kind : {ColumnKind::coordinate, ColumnKind::velocity, ColumnKind::state, ColumnKind::monitor})
    for (std::size_t k = 0; k < columns.size(); ++k)
      if (columns[k].kind == kind) places.push_back(k);
  return places;
}

}  // namespace anholon
