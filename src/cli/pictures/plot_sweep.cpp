#include "cli/pictures/plot_sweep.h"

#include <algorithm>
#include <cmath>

#include "cli/pictures/sweep_cases.h"

namespace anholon::cli {

namespace {

using plot::NamedColumn;

// A number below which lies this part of the sorted numbers, between them linearly.
double quantile(const std::vector<double>& sorted, double part) {
  const double at = part * static_cast<double>(sorted.size() - 1);
  const auto k = static_cast<std::size_t>(at);
  const double next = k + 1 < sorted.size() ? sorted[k + 1] : sorted[k];
  return sorted[k] + (next - sorted[k]) * (at - static_cast<double>(k));
}

// A curve over the variation; where several cases have the same value of it, their quantiles of 10, 50 and 90 %.
RunFile over_one(const NamedColumn& x, const NamedColumn& of) {
  std::map<double, std::vector<double>> groups;
  for (std::size_t k = 0; k < x.values.size(); ++k)
    if (std::isfinite(x.values[k]) && std::isfinite(of.values[k])) groups[x.values[k]].push_back(of.values[k]);
  const bool several = std::any_of(groups.begin(), groups.end(), [](const auto& g) { return g.second.size() > 1; });
  RunFile run;
  std::vector<std::string> names{x.name};
  for (const char* part : {" 10 %", " 50 %", " 90 %"})
    if (several) names.push_back(of.name + part);
  if (!several) names.push_back(of.name);
  run.table.set_columns(names);
  if (!x.unit.empty()) run.units[x.name] = x.unit;
  for (std::size_t k = 1; k < names.size(); ++k)
    if (!of.unit.empty()) run.units[names[k]] = of.unit;
  for (auto& [at, values] : groups) {
    std::sort(values.begin(), values.end());
    run.table.values.growing(0).push_back(at);
    if (!several) run.table.values.growing(1).push_back(values[0]);
    for (std::size_t k = 0; several && k < 3; ++k)
      run.table.values.growing(k + 1).push_back(quantile(values, 0.1 + 0.4 * static_cast<double>(k)));
  }
  return run;
}

}  // namespace

SweepPicture picture_of_sweep(const PlotCommand& o) {
  const SweepCases cases(o.run);
  const std::vector<std::string> asked = split(o.columns);
  if (asked.size() > 1) throw Failure({}, "a figure of a sweep shows one column", "one name, or none for the outcomes");
  std::vector<std::string> words;
  SweepPicture picture;
  if (!o.histogram.empty()) {
    if (!asked.empty() || !o.abscissa.empty() || !o.ordinate.empty())
      throw Failure({}, "a histogram shows one column and has no further axis", "--histogram theta alone");
    NamedColumn of = cases.read({o.histogram}, words)[0];
    picture.histogram = plot::make_histogram(std::move(of), std::move(words));
    picture.histogram->title = o.title;
    return picture;
  }
  std::vector<std::string> axes;
  for (const std::string& given : {o.abscissa, o.ordinate})
    if (!given.empty()) axes.push_back(given);
  for (const std::string& name : cases.varied())
    if (axes.size() < 2 && std::find(axes.begin(), axes.end(), name) == axes.end()) axes.push_back(name);
  if (axes.empty())
    throw Failure({}, "the columns of the sweep do not tell what varies", "--x and --y name columns of the sweep");
  const std::string shown = asked.empty() ? "outcome" : asked[0];
  std::vector<NamedColumn> of = cases.read({shown}, words), at = cases.read(axes, words);
  if (at.size() == 1) {
    if (!words.empty())
      throw Failure({}, "one variation shows numbers, and '" + shown + "' holds words",
                    "name a column of numbers, or --histogram " + shown);
    picture.table = over_one(at[0], of[0]);
    picture.abscissa = at[0].name;
    return picture;
  }
  picture.map = make_heat_map(std::move(at[0]), std::move(at[1]), of[0], std::move(words), cases.generations());
  picture.map->title = o.title;
  return picture;
}

}  // namespace anholon::cli
