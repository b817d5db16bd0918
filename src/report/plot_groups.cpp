#include "report/plot_groups.h"

#include <algorithm>

namespace anholon {

namespace {

// The title of a part: the unit of its columns, or the first of them by their names.
std::string title_of_part(const std::string& title, const std::vector<const PlotColumn*>& columns) {
  if (const std::string& unit = columns[0]->unit; !unit.empty() && unit != "1") return title + " in " + unit;
  constexpr std::size_t kMostNames = 4;
  std::string names;
  for (std::size_t k = 0; k < std::min(columns.size(), kMostNames); ++k)
    names += (names.empty() ? " " : ", ") + columns[k]->name;
  return title + names + (columns.size() > kMostNames ? ", …" : "");
}

}  // namespace

const std::vector<PlotGroup>& all_plot_groups() {
  static const std::vector<PlotGroup> list = {{"coordinates", "Coordinates"},
                                              {"velocities", "Velocities"},
                                              {"accelerations", "Accelerations"},
                                              {"third derivatives", "Third derivatives"},
                                              {"fourth derivatives", "Fourth derivatives"},
                                              {"states", "States"},
                                              {"multipliers", "Multipliers"},
                                              {"reactions", "Generalized reactions"},
                                              {"energies", "Energies"},
                                              {"integrals", "Integrals of the motion"},
                                              {"monitors", "Outputs and monitors"},
                                              {"residuals", "Residuals of the stored rows", true},
                                              {"steps", "Size of the steps", true}};
  return list;
}

std::vector<PlotGroup> parted_groups(std::vector<PlotColumn>& columns, const Dimensions& dimensions) {
  std::vector<PlotGroup> all;
  for (const PlotGroup& group : all_plot_groups()) {
    std::vector<std::string> different;
    std::vector<std::vector<PlotColumn*>> parts;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (columns[k].group != group.id) continue;
      const auto at =
          static_cast<std::size_t>(std::find(different.begin(), different.end(), dimensions[k]) - different.begin());
      if (at == different.size()) different.push_back(dimensions[k]), parts.emplace_back();
      parts[at].push_back(&columns[k]);
    }
    if (parts.size() < 2) {
      all.push_back(group);
      continue;
    }
    for (std::size_t k = 0; k < parts.size(); ++k) {
      PlotGroup part = group;
      part.id += " " + std::to_string(k + 1);
      part.title = title_of_part(group.title, {parts[k].begin(), parts[k].end()});
      for (PlotColumn* c : parts[k]) c->group = part.id;
      all.push_back(std::move(part));
    }
  }
  return all;
}

}  // namespace anholon
