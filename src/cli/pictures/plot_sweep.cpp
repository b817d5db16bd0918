#include "cli/pictures/plot_sweep.h"

#include <algorithm>

#include "cli/pictures/sweep_cases.h"
#include "plot/over_variation.h"

namespace anholon::cli {

using plot::NamedColumn;

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
    picture.table = plot::over_variation(at[0], of);
    picture.abscissa = at[0].name;
    return picture;
  }
  picture.map = make_heat_map(std::move(at[0]), std::move(at[1]), of[0], std::move(words), cases.generations());
  picture.map->title = o.title;
  return picture;
}

}  // namespace anholon::cli
