#include "cli/pictures/plot_sweep.h"

#include <algorithm>
#include <cmath>

#include "ensemble/store/sweep_store.h"
#include "observe/rows/row_values.h"

namespace anholon::cli {

namespace {

using plot::NamedColumn;

// The rows of all parts that are there.
class SweepData {
 public:
  explicit SweepData(const std::string& folder) : store_(SweepStore::open(folder)) {
    const std::vector<std::string>& names = store_.request().columns;
    // What varies stands between the number of the case and its outcome.
    for (const std::string& name : names) {
      if (name == "outcome") break;
      if (name != "case" && name != "t" && name != "case_name") varied_.push_back(name);
    }
    read_units();
  }
  const std::vector<std::string>& varied() const { return varied_; }

  // Columns by name; the words of a column of words are added to `words`, and its values are their indices.
  std::vector<NamedColumn> read(const std::vector<std::string>& names, std::vector<std::string>& words) const {
    std::vector<NamedColumn> all;
    std::vector<std::size_t> places;
    for (const std::string& name : names) {
      const std::vector<std::string>& there = store_.request().columns;
      const auto at = std::find(there.begin(), there.end(), name);
      if (at == there.end()) {
        std::string list;
        for (const std::string& n : there) list += (list.empty() ? "" : ", ") + n;
        throw Failure({}, "the sweep has no column '" + name + "'", "its columns are " + list);
      }
      places.push_back(static_cast<std::size_t>(at - there.begin()));
      all.push_back({name, unit_of(name), {}});
    }
    for (const std::size_t part : store_.present()) {
      const ParquetTable table = store_.read(part);
      for (std::size_t k = 0; k < all.size(); ++k) append(all[k].values, table.columns.at(places[k]), words);
    }
    return all;
  }

 private:
  static void append(std::vector<double>& to, const ParquetColumn& from, std::vector<std::string>& words) {
    if (const auto* numbers = std::get_if<std::vector<double>>(&from.values)) {
      to.insert(to.end(), numbers->begin(), numbers->end());
    } else if (const auto* whole = std::get_if<std::vector<std::int64_t>>(&from.values)) {
      to.insert(to.end(), whole->begin(), whole->end());
    } else {
      const Words& w = std::get<Words>(from.values);
      std::vector<double> places;
      for (const std::string& word : w.different) {
        const auto at = std::find(words.begin(), words.end(), word);
        places.push_back(static_cast<double>(at - words.begin()));
        if (at == words.end()) words.push_back(word);
      }
      for (const std::uint32_t k : w.rows) to.push_back(places[k]);
    }
  }
  // Units come from the model in the folder; a model that refers to files that are not there has none.
  void read_units() {
    Diagnostics diagnostics;
    const auto model = read_model(SourceText{store_.folder(), store_.asked("model")}, diagnostics);
    if (!model) return;
    units_ = column_units(*model);
    for (std::size_t k = 0; k < std::min(model->parameters.size(), model->parameter_units.size()); ++k)
      units_.emplace(model->parameters[k].name, model->parameter_units[k]);
  }
  std::string unit_of(std::string name) const {
    if (name.ends_with("(0)")) name.resize(name.size() - 3);
    const auto at = units_.find(name);
    return at == units_.end() ? std::string() : at->second;
  }

  SweepStore store_;
  std::vector<std::string> varied_;
  std::map<std::string, std::string> units_;
};

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

bool is_sweep_folder(const std::string& path) { return SweepStore::is_there(path); }

SweepPicture picture_of_sweep(const Options& o) {
  const SweepData data(o.model);
  std::vector<std::string> axes;
  for (const std::string& given : {o.abscissa, o.ordinate})
    if (!given.empty()) axes.push_back(given);
  for (const std::string& name : data.varied())
    if (axes.size() < 2 && std::find(axes.begin(), axes.end(), name) == axes.end()) axes.push_back(name);
  if (axes.empty())
    throw Failure({}, "the columns of the sweep do not tell what varies", "--x and --y name columns of the sweep");
  const std::vector<std::string> asked = split(o.columns);
  if (asked.size() > 1) throw Failure({}, "a figure of a sweep shows one column", "one name, or none for the outcomes");
  const std::string shown = asked.empty() ? "outcome" : asked[0];
  std::vector<std::string> words;
  std::vector<NamedColumn> of = data.read({shown}, words), at = data.read(axes, words);
  SweepPicture picture;
  if (at.size() == 1) {
    if (!words.empty())
      throw Failure({}, "one variation shows numbers, and '" + shown + "' holds words", "name a column of numbers");
    picture.table = over_one(at[0], of[0]);
    picture.abscissa = at[0].name;
    return picture;
  }
  picture.map = make_heat_map(std::move(at[0]), std::move(at[1]), of[0], std::move(words));
  picture.map->title = o.title;
  return picture;
}

}  // namespace anholon::cli
