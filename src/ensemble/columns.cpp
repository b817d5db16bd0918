#include "ensemble/columns.h"

#include <algorithm>

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

std::vector<std::optional<std::size_t>> ensemble_places(const Model& model, const std::vector<RunColumn>& columns) {
  std::vector<std::optional<std::size_t>> places;
  const auto add = [&](ColumnKind kind, std::size_t index) {
    const auto at = std::find_if(columns.begin(), columns.end(),
                                 [&](const RunColumn& c) { return c.kind == kind && c.index == index; });
    places.push_back(at == columns.end() ? std::nullopt
                                         : std::optional(static_cast<std::size_t>(at - columns.begin())));
  };
  for (const ColumnKind kind : {ColumnKind::coordinate, ColumnKind::velocity})
    for (std::size_t a = 0; a < model.coordinates.size(); ++a) add(kind, a);
  for (std::size_t z = 0; z < model.states.size(); ++z) add(ColumnKind::state, z);
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (columns[k].kind == ColumnKind::monitor) places.emplace_back(k);
  return places;
}

}  // namespace anholon
