// A figure of a sweep: curves over the number that varies, or cells over two of them.
#include <algorithm>

#include "anholon/page.h"
#include "api/sweep_data.h"
#include "ensemble/ending.h"
#include "plot/drawing.h"
#include "plot/over_variation.h"
#include "result/choose_columns.h"

namespace anholon::v1 {

namespace {

using inner::plot::NamedColumn;

constexpr const char* kOutcome = "outcome";

// The columns of a sweep by their names in its table: the varied values, the outcome, the time, the steps, the others.
class FigureColumns {
 public:
  explicit FigureColumns(const Sweep& sweep) : sweep_(sweep), d_(sweep.data()) {
    const inner::Model& model = *d_.model->model;
    for (const std::string& name : d_.names) {
      const bool parameter = std::any_of(model.parameters.begin(), model.parameters.end(),
                                         [&](const inner::Parameter& p) { return p.name == name; });
      varied_.push_back(parameter ? name : name + "(0)");
    }
    all_ = varied_;
    all_.insert(all_.end(), {kOutcome, "t", "steps"});
    all_.insert(all_.end(), d_.columns.begin(), d_.columns.end());
  }

  const std::vector<std::string>& varied() const { return varied_; }
  // Throws Failure.
  std::vector<std::string> chosen(const std::vector<std::string>& names) const {
    std::vector<std::string> list;
    for (const std::size_t k : inner::chosen_columns(all_, names)) list.push_back(all_[k]);
    return list;
  }
  // Returns the coordinates among the columns; all columns if there are none.
  std::vector<std::string> usual() const {
    std::vector<std::string> list;
    for (const inner::Coordinate& q : d_.model->model->coordinates)
      if (std::find(d_.columns.begin(), d_.columns.end(), q.name) != d_.columns.end()) list.push_back(q.name);
    return list.empty() ? d_.columns : list;
  }
  // Returns the numbers of an existing column; for outcomes their indices among the words.
  NamedColumn read(const std::string& name, std::vector<std::string>& words) const {
    const auto at = static_cast<std::size_t>(std::find(varied_.begin(), varied_.end(), name) - varied_.begin());
    if (at < varied_.size()) return {name, unit(d_.names[at]), d_.varied[at]};
    if (name == kOutcome) return outcomes(words);
    if (name == "t") return {name, unit(name), d_.t};
    if (name == "steps") return {name, "", {d_.steps.begin(), d_.steps.end()}};
    const std::span<const double> values = sweep_.column(name);
    return {name, unit(name), {values.begin(), values.end()}};
  }

 private:
  std::string unit(const std::string& name) const {
    const auto it = d_.units.find(name);
    return it == d_.units.end() ? "" : it->second;
  }
  NamedColumn outcomes(std::vector<std::string>& words) const {
    NamedColumn column{kOutcome, "", {}};
    for (std::size_t k = 0; k < d_.outcomes.size(); ++k) {
      const std::string word = inner::ending(name(d_.outcomes[k].kind), sweep_.event(k));
      const auto at = std::find(words.begin(), words.end(), word);
      column.values.push_back(static_cast<double>(at - words.begin()));
      if (at == words.end()) words.push_back(word);
    }
    return column;
  }

  const Sweep& sweep_;
  const Sweep::Data& d_;
  std::vector<std::string> varied_, all_;
};

// Returns the columns that x and y name, then those that vary, two at most. Throws Failure.
std::vector<std::string> axes_of(const FigureColumns& columns, const SweepFigureOptions& o) {
  std::vector<std::string> axes;
  for (const std::string& given : {o.x, o.y})
    if (!given.empty()) axes.push_back(columns.chosen({given}).at(0));
  for (const std::string& name : columns.varied())
    if (axes.size() < 2 && std::find(axes.begin(), axes.end(), name) == axes.end()) axes.push_back(name);
  if (axes.empty()) throw inner::Failure({}, "no number varies in this sweep", "x names the column below the figure");
  if (axes.size() > 1 && axes[0] == axes[1])
    throw inner::Failure({}, "x and y are both '" + axes[0] + "'", "y names another column");
  return axes;
}

}  // namespace

Result<std::string> figure(const Sweep& sweep, const SweepFigureOptions& o) {
  return guarded(sweep.data().model->source, [&]() -> Result<std::string> {
    const FigureColumns columns(sweep);
    const std::vector<std::string> axes = axes_of(columns, o);
    std::vector<std::string> names = columns.chosen(o.columns), words;
    std::vector<NamedColumn> at;
    for (const std::string& axis : axes) at.push_back(columns.read(axis, words));
    if (!words.empty()) return mistake("an axis shows numbers, and 'outcome' holds words", "x = \"t\"");
    if (axes.size() == 1) {
      if (names.empty()) names = columns.usual();
      std::vector<NamedColumn> list;
      for (const std::string& name : names) list.push_back(columns.read(name, words));
      if (!words.empty())
        return mistake("one variation shows numbers, and 'outcome' holds words", "name columns of numbers");
      const inner::RunFile run = inner::plot::over_variation(at[0], list);
      if (run.table.rows() == 0) return mistake("no case has finite numbers of these columns");
      inner::plot::FigureOptions options;
      options.x = at[0].name;
      options.names.assign(run.table.columns.begin() + 1, run.table.columns.end());
      return inner::plot::draw_svg(inner::plot::make_figure(run, options));
    }
    if (names.empty()) names = {kOutcome};
    if (names.size() > 1)
      return mistake("a map over two variations shows one column, and there are " + std::to_string(names.size()),
                     "one name, or none for the outcomes");
    const NamedColumn shown = columns.read(names[0], words);
    return inner::plot::draw_svg(
        lay_out(inner::plot::make_heat_map(std::move(at[0]), std::move(at[1]), shown, std::move(words))), "");
  });
}

}  // namespace anholon::v1
