#include "plot/over_variation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace anholon::plot {

namespace {

// Returns the quantile of sorted numbers for this part, linear between them; NaN if there are none.
double quantile(const std::vector<double>& sorted, double part) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double at = part * static_cast<double>(sorted.size() - 1);
  const auto k = static_cast<std::size_t>(at);
  const double next = k + 1 < sorted.size() ? sorted[k + 1] : sorted[k];
  return sorted[k] + (next - sorted[k]) * (at - static_cast<double>(k));
}

}  // namespace

RunFile over_variation(const NamedColumn& x, const std::vector<NamedColumn>& columns) {
  std::map<double, std::vector<std::vector<double>>> groups;  // for each x the numbers of each column
  bool several = false;
  for (const double point : x.points) groups[point].resize(columns.size());
  for (std::size_t k = 0; k < x.values.size(); ++k)
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (!std::isfinite(x.values[k]) || !std::isfinite(columns[c].values[k])) continue;
      auto& group = groups[x.values[k]];
      group.resize(columns.size());
      group[c].push_back(columns[c].values[k]);
      several = several || group[c].size() > 1;
    }
  const std::vector<double> parts = several ? std::vector<double>{0.1, 0.5, 0.9} : std::vector<double>{0.5};
  RunFile run;
  std::vector<std::string> names{x.name};
  if (!x.unit.empty()) run.units[x.name] = x.unit;
  for (const NamedColumn& c : columns)
    for (const double part : parts) {
      names.push_back(c.name + (several ? " " + std::to_string(std::lround(100 * part)) + " %" : ""));
      if (!c.unit.empty()) run.units[names.back()] = c.unit;
    }
  run.table.set_columns(names);
  for (auto& [at, group] : groups) {
    run.table.values.growing(0).push_back(at);
    std::size_t next = 1;
    for (std::vector<double>& values : group) {
      std::sort(values.begin(), values.end());
      for (const double part : parts) run.table.values.growing(next++).push_back(quantile(values, part));
    }
  }
  return run;
}

std::vector<NamedRun> runs_of_cases(const std::vector<double>& numbers, const NamedColumn& x,
                                    const std::vector<NamedColumn>& columns,
                                    const std::function<std::string(std::size_t row)>& name) {
  std::vector<const NamedColumn*> all{&x};
  std::vector<std::string> names{x.name};
  for (const NamedColumn& c : columns) all.push_back(&c), names.push_back(c.name);
  std::vector<NamedRun> runs;
  for (std::size_t from = 0, to = 0; from < numbers.size(); from = to) {
    NamedRun one;
    one.run.table.set_columns(names);
    bool any = false;
    for (; to < numbers.size() && numbers[to] == numbers[from]; ++to)
      for (std::size_t k = 0; k < all.size(); ++k) {
        one.run.table.values.growing(k).push_back(all[k]->values[to]);
        any = any || (k > 0 && std::isfinite(x.values[to]) && std::isfinite(all[k]->values[to]));
      }
    if (!any) continue;
    for (const NamedColumn* c : all)
      if (!c->unit.empty()) one.run.units[c->name] = c->unit;
    one.name = name(from);
    runs.push_back(std::move(one));
  }
  return runs;
}

}  // namespace anholon::plot
