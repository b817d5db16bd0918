#include "api/pictures/sweep_picture.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/join.h"
#include "plot/over_variation.h"

namespace anholon::v1 {

namespace {

using inner::Failure;
using inner::plot::NamedColumn;

// The word for no axis: a curve is drawn, with quantiles over the other numbers that vary.
constexpr const char* kNoAxis = "none";

// Formats a number of a legend with few digits.
std::string in_legend(double v) {
  constexpr int kDigits = 6;
  char buffer[64];
  const auto r = std::to_chars(buffer, buffer + sizeof buffer, v, std::chars_format::general, kDigits);
  return {buffer, r.ptr};
}

// True if the values of a column were drawn at random: the request of a folder says so, or each case has a value of its
// own.
bool drawn(const SweepCases& cases, const std::string& name, std::size_t different, std::size_t all) {
  if (different == all) return true;
  if (!cases.store()) return false;
  const std::string of = name.ends_with("(0)") ? name.substr(0, name.size() - 3) : name;
  const std::string words = ' ' + cases.store()->asked("vary");
  return words.find(' ' + of + '~') != std::string::npos ||
         cases.store()->asked("vary " + of).find('~') != std::string::npos;
}

// Returns the columns that vary, without those drawn at random for the points of a grid, over which quantiles are
// shown.
std::vector<std::string> axes_that_vary(const SweepCases& cases) {
  const auto different = [&](const std::string& name) {
    std::vector<std::string> words;
    std::vector<double> values = cases.read({name}, words)[0].values;
    std::erase_if(values, [](double x) { return std::isnan(x); });
    std::sort(values.begin(), values.end());
    return static_cast<std::size_t>(std::unique(values.begin(), values.end()) - values.begin());
  };
  if (cases.varied().size() < 2 || !cases.has("case")) return cases.varied();
  const std::size_t all = different("case");
  std::vector<std::string> grids;
  bool drawn_ones = false, steps = false;  // a grid has several points
  for (const std::string& name : cases.varied()) {
    const std::size_t count = different(name);
    if (drawn(cases, name, count, all)) {
      drawn_ones = true;
      continue;
    }
    steps = steps || count > 1;
    grids.push_back(name);
  }
  return drawn_ones && steps ? grids : cases.varied();
}

std::vector<std::string> axes_of(const SweepCases& cases, const SweepPictureRequest& o,
                                 const std::vector<std::string>& shown, bool numbers) {
  const auto is_in = [](const std::vector<std::string>& list, const std::string& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  const bool one = o.y == kNoAxis && !cases.has(kNoAxis);
  std::vector<std::string> axes;
  for (const std::string& given : {o.x, one ? "" : o.y})
    if (!given.empty()) axes.push_back(given);
  for (const std::string& name : numbers && (o.y.empty() || one) ? axes_that_vary(cases) : cases.varied())
    if (axes.size() < (one ? 1 : 2) && !is_in(shown, name) && !is_in(axes, name)) axes.push_back(name);
  if (axes.empty())
    throw Failure({}, "the columns of the sweep do not tell what varies",
                  o.dashes + "x and " + o.dashes + "y name columns of the sweep");
  return axes;
}

// Draws a curve of each case over x or, of many cases, their quantiles over t. Returns false if another kind of picture
// is needed: the cases have one row each, words are shown, or an axis that varies is named.
bool take_curves(SweepPicture& picture, const SweepCases& cases, const SweepPictureRequest& o,
                 const std::vector<std::string>& shown) {
  const std::vector<std::string>& varied = cases.varied();
  if (!cases.rows_at_times() || !o.y.empty() || std::find(varied.begin(), varied.end(), o.x) != varied.end())
    return false;
  std::vector<std::string> words, no_words;
  const std::vector<NamedColumn> of = cases.read(shown, words);
  const std::string abscissa = o.x.empty() ? "t" : o.x;
  if (!words.empty()) return false;
  const std::vector<NamedColumn> first = cases.read({"case", abscissa}, words);
  if (!words.empty()) return false;
  const std::vector<NamedColumn> numbers = cases.read(varied, no_words);
  const bool named = cases.has("case_name");
  const NamedColumn scenario = named ? cases.read({"case_name"}, words)[0] : NamedColumn();
  const auto name = [&](std::size_t row) {
    std::string text = named ? words[static_cast<std::size_t>(scenario.values[row])] : "";
    for (const NamedColumn& n : numbers) text += (text.empty() ? "" : ", ") + n.name + " = " + in_legend(n.values[row]);
    return text.empty() ? "case " + in_legend(first[0].values[row]) : text;
  };
  picture.curves = inner::plot::runs_of_cases(first[0].values, first[1], of, name);
  if (picture.curves.empty())
    throw Failure({}, "no case has a number of '" + inner::joined(shown, ", ") + "' over '" + abscissa + "'",
                  "another column");
  picture.options.x = abscissa;
  picture.options.names = shown;
  if (picture.curves.size() <= kMostCurves) return true;
  if (abscissa != "t")
    throw Failure({}, std::to_string(picture.curves.size()) + " cases are too many curves for one figure",
                  "without " + o.dashes + "x their quantiles over t, or " + o.dashes + "x and " + o.dashes +
                      "y for cells");
  picture.curves = {{inner::plot::over_variation(first[1], of), ""}};
  const std::vector<std::string>& columns = picture.curves[0].run.table.columns;
  picture.options.names.assign(columns.begin() + 1, columns.end());
  return true;
}

// Returns curves over one variation. If the cases have several scenarios, each has its curves, with the columns of the
// others.
std::vector<inner::plot::NamedRun> curves_of_scenarios(const SweepCases& cases, const NamedColumn& at,
                                                       const std::vector<NamedColumn>& of) {
  std::vector<inner::plot::NamedRun> together = {{inner::plot::over_variation(at, of), ""}}, curves;
  if (!cases.has("case_name")) return together;
  std::vector<std::string> words;
  const NamedColumn scenario = cases.read({"case_name"}, words)[0];
  if (words.size() < 2 || words.size() > kMostCurves) return together;
  for (std::size_t k = 0; k < words.size(); ++k) {
    const auto own = [&](NamedColumn c) {
      std::vector<double> values;
      for (std::size_t row = 0; row < c.values.size(); ++row)
        if (scenario.values[row] == static_cast<double>(k)) values.push_back(c.values[row]);
      c.values = std::move(values);
      return c;
    };
    std::vector<NamedColumn> list;
    for (const NamedColumn& c : of) list.push_back(own(c));
    curves.push_back({inner::plot::over_variation(own(at), list), words[k]});
    if (curves[k].run.table.columns != curves[0].run.table.columns) return together;
  }
  return curves;
}

// Returns the title, with the note if parts are missing. Throws Failure if there is no part.
std::string title_with(SweepPicture& picture, const SweepCases& cases, const std::string& title) {
  if (!cases.store()) return title;
  const std::size_t there = cases.store()->present().size(), all = cases.store()->parts();
  if (there == 0)
    throw Failure({}, "no part is in " + cases.store()->folder(), "the command of the sweep computes them");
  if (there == all) return title;
  picture.note = std::to_string(there) + " of " + std::to_string(all) + " parts";
  return title.empty() ? picture.note : title + " (" + picture.note + ")";
}

}  // namespace

SweepPicture picture_of_sweep(const SweepCases& cases, const SweepPictureRequest& o) {
  std::vector<std::string> words;
  SweepPicture picture;
  const std::string title = title_with(picture, cases, o.title);
  picture.options.title = title;
  if (!o.histogram.empty()) {
    if (!o.columns.empty() || !o.x.empty() || !o.y.empty())
      throw Failure({}, "a histogram shows one column and has no further axis", o.dashes + "histogram theta alone");
    NamedColumn of = cases.read({o.histogram}, words)[0];
    picture.histogram = inner::plot::make_histogram(std::move(of), std::move(words));
    picture.histogram->title = title;
    return picture;
  }
  if (o.columns.empty() && !cases.has("outcome"))
    throw Failure({}, "the sweep does not keep how its cases ended, so a figure of it needs a column",
                  "name one of its columns: " + inner::joined(cases.names(), ", "));
  const std::vector<std::string> shown = o.columns.empty() ? std::vector<std::string>{"outcome"} : o.columns;
  if (take_curves(picture, cases, o, shown)) return picture;
  std::vector<std::string> shown_words;
  const std::vector<NamedColumn> of = cases.read(shown, shown_words);
  const std::vector<std::string> axes = axes_of(cases, o, shown, shown_words.empty());
  std::vector<NamedColumn> at = cases.read(axes, words);
  if (!words.empty())
    throw Failure({}, "an axis shows numbers, and '" + inner::joined(axes, "' or '") + "' holds words",
                  o.dashes + "x names a column of numbers");
  if (at.size() == 1) {
    if (!shown_words.empty())
      throw Failure({}, "one variation shows numbers, and '" + inner::joined(shown, "' or '") + "' holds words",
                    "name a column of numbers" +
                        (o.dashes.empty() ? "" : ", or " + o.dashes + "histogram " + shown[0]));
    picture.curves = curves_of_scenarios(cases, at[0], of);
    picture.options.x = at[0].name;
    const std::vector<std::string>& columns = picture.curves[0].run.table.columns;
    picture.options.names.assign(columns.begin() + 1, columns.end());
    return picture;
  }
  if (of.size() > 1)
    throw Failure({}, "a map over two variations shows one column, and there are " + std::to_string(of.size()),
                  "one name, or none for the outcomes");
  picture.map = make_heat_map(std::move(at[0]), std::move(at[1]), of[0], std::move(shown_words), cases.generations());
  picture.map->title = title;
  return picture;
}

}  // namespace anholon::v1
