#include "api/pictures/sweep_cases.h"

#include <algorithm>
#include <fstream>

#include "api/sweep_case.h"
#include "base/join.h"
#include "base/read_file.h"
#include "ensemble/ending.h"
#include "modelfile/read.h"
#include "observe/rows/quantity_units.h"
#include "result/format.h"
#include "result/table.h"

namespace anholon::v1 {

namespace {

using inner::Diagnostics;
using inner::Failure;
using inner::ParquetColumn;
using inner::ParquetTable;
using inner::SweepStore;
using inner::Words;
using inner::plot::NamedColumn;

bool heads_a_sweep(const std::vector<std::string>& names) {
  return !names.empty() && names[0] == "case" && names.size() > 1;
}

// Reads the table of a CSV file that `anholon sweep` wrote. A column with a cell that is no number holds words.
ParquetTable table_of_csv(std::string_view text, const std::string& path) {
  ParquetTable table;
  std::vector<std::vector<double>> numbers;
  std::vector<Words> words;
  std::vector<bool> worded;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.empty()) continue;
    const std::vector<std::string> cells = table.columns.empty() ? inner::split_csv(line) : inner::csv_cells(line);
    if (table.columns.empty()) {
      for (const std::string& name : cells) table.columns.push_back({name, {}});
      numbers.resize(cells.size()), words.resize(cells.size()), worded.resize(cells.size());
      continue;
    }
    if (cells.size() != table.columns.size())
      throw Failure({}, path + ", line " + std::to_string(number) + " has " + std::to_string(cells.size()) +
                            " cells, and the first line names " + std::to_string(table.columns.size()));
    for (std::size_t k = 0; k < cells.size(); ++k) {
      double value = std::numeric_limits<double>::quiet_NaN();
      if (!cells[k].empty() && !inner::parse_number(cells[k], value)) worded[k] = true;
      numbers[k].push_back(value), words[k].add(cells[k]);
    }
  }
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    const std::string& name = table.columns[k].name;
    if (worded[k] || inner::is_column_of_words(name))
      table.columns[k].values = std::move(words[k]);
    else
      table.columns[k].values = std::move(numbers[k]);
  }
  return table;
}

void append(std::vector<double>& to, const ParquetColumn& from, std::vector<std::string>& words) {
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

// Returns the outcomes, with the names of the events that ended motions.
ParquetColumn endings(const ParquetColumn& outcomes, const ParquetColumn& events) {
  const Words *how = std::get_if<Words>(&outcomes.values), *by = std::get_if<Words>(&events.values);
  if (!how || !by) return outcomes;
  // Each pair of words is joined once.
  constexpr std::uint32_t kNew = ~std::uint32_t{0};
  std::vector<std::uint32_t> known(how->different.size() * by->different.size(), kNew);
  Words all;
  for (std::size_t row = 0; row < how->rows.size(); ++row) {
    std::uint32_t& place = known[how->rows[row] * by->different.size() + by->rows[row]];
    if (place == kNew) {
      std::string word = inner::ending(how->different[how->rows[row]], by->different[by->rows[row]]);
      const auto at = std::find(all.different.begin(), all.different.end(), word);
      place = static_cast<std::uint32_t>(at - all.different.begin());
      if (at == all.different.end()) all.different.push_back(std::move(word));
    }
    all.rows.push_back(place);
  }
  return {outcomes.name, std::move(all)};
}

std::string text_of(const std::string& path) {
  std::string text, why;
  if (!inner::read_file(path, text, &why)) throw Failure({}, "cannot read " + path + ": " + why);
  return text;
}

}  // namespace

bool SweepCases::are_in(const std::string& path) {
  if (SweepStore::is_there(path)) return true;
  if (inner::format_of(path) == &inner::plain_format()) {
    std::string line;
    std::ifstream file(path);
    std::getline(file, line);
    if (line.ends_with('\r')) line.pop_back();
    return heads_a_sweep(inner::split_csv(line));
  }
  // Files of other formats may be large, so only the first bytes are read.
  char beginning[4] = {};
  if (!std::ifstream(path, std::ios::binary).read(beginning, sizeof beginning) ||
      std::string_view(beginning, sizeof beginning) != "PAR1")
    return false;
  std::string text;
  if (!inner::read_file(path, text, nullptr)) return false;
  std::vector<std::string> names;
  try {
    for (const ParquetColumn& c : inner::read_parquet(text).columns) names.push_back(c.name);
  } catch (const Failure&) {
    return false;  // the reader of runs reports the fault
  }
  return heads_a_sweep(names);
}

SweepCases::SweepCases(const std::string& path) {
  if (SweepStore::is_there(path)) {
    store_ = opened_to_read(path);
    names_ = store_->request().columns;
    read_model();
  } else {
    const std::string text = text_of(path);
    file_ = inner::format_of(path) == &inner::plain_format() ? table_of_csv(text, path) : inner::read_parquet(text);
    for (const ParquetColumn& c : file_.columns) names_.push_back(c.name);
  }
  see_what_varies();
  if (store_ && !store_->missing().empty())
    for (auto& [name, points] : points_of_axes(*store_)) known_[name].points = std::move(points);
}

// The varied columns stand between the number of the case and its outcome. If there are no outcome columns, their end
// is unknown: if cases have several rows, the varied columns are those that are constant in all rows of a case.
void SweepCases::see_what_varies() {
  std::vector<double> numbers;
  std::vector<std::string> words;
  if (has("case") && has("t")) numbers = read({"case"}, words)[0].values;
  at_times_ = std::adjacent_find(numbers.begin(), numbers.end()) != numbers.end();
  const auto changes_in_a_case = [&](const std::string& name) {
    const std::vector<double> values = read({name}, words)[0].values;
    for (std::size_t k = 1; k < numbers.size(); ++k)
      if (numbers[k] == numbers[k - 1] && values[k] != values[k - 1]) return true;
    return false;
  };
  const bool known = has("outcome");
  for (const std::string& name : names_) {
    if (name == "outcome") break;
    if (name == "case" || name == "t" || name == "case_name") continue;
    if (!known && at_times_ && changes_in_a_case(name)) break;
    varied_.push_back(name);
  }
}

bool SweepCases::has(const std::string& name) const {
  return std::find(names_.begin(), names_.end(), name) != names_.end();
}

void SweepCases::each_table(const std::function<void(const ParquetTable&)>& take) const {
  if (!store_) return take(file_);
  for (const std::size_t part : store_->present()) take(store_->read(part));
}

std::vector<NamedColumn> SweepCases::read(const std::vector<std::string>& wanted,
                                          std::vector<std::string>& words) const {
  std::vector<NamedColumn> all;
  std::vector<std::size_t> places;
  for (const std::string& name : wanted) {
    const auto at = std::find(names_.begin(), names_.end(), name);
    if (at == names_.end())
      throw Failure({}, "the sweep has no column '" + name + "'", "its columns are " + inner::joined(names_, ", "));
    places.push_back(static_cast<std::size_t>(at - names_.begin()));
    const std::string of = name.ends_with("(0)") ? name.substr(0, name.size() - 3) : name;
    NamedColumn& column = all.emplace_back();
    if (const auto known = known_.find(of); known != known_.end()) column = known->second;
    if (const auto known = known_.find(name); known != known_.end()) column.points = known->second.points;
    column.name = name;
  }
  const auto event = static_cast<std::size_t>(std::find(names_.begin(), names_.end(), "event") - names_.begin());
  each_table([&](const ParquetTable& table) {
    for (std::size_t k = 0; k < all.size(); ++k) {
      const ParquetColumn& column = table.columns.at(places[k]);
      if (column.name == "outcome" && event < names_.size())
        append(all[k].values, endings(column, table.columns.at(event)), words);
      else
        append(all[k].values, column, words);
    }
  });
  return all;
}

std::vector<unsigned> SweepCases::generations() const {
  std::vector<unsigned> list;
  if (!store_ || store_->generations().size() == 1) return list;
  std::vector<std::string> none;
  const std::vector<NamedColumn> numbers = read({"case"}, none);
  for (const double number : numbers[0].values)
    list.push_back(
        static_cast<unsigned>(inner::generation_of(store_->generations(), static_cast<std::size_t>(number))));
  return list;
}

// Returns no command for a sweep in one mode: `report` shows a motion with its changes of mode, Python one in a single
// mode.
std::string SweepCases::command() const {
  return store_ && store_->asked("mode").empty() ? command_of_sweep(*store_) : std::string();
}

// Reads units and meanings from the model in the folder; there are none if the model refers to files that do not exist.
void SweepCases::read_model() {
  Diagnostics diagnostics;
  const auto open = inner::open_model(model_asked(store_->request()), diagnostics);
  if (!open) return;
  for (const auto& [name, unit] : inner::quantity_units(*open->model, inner::contacts(*open->names)))
    known_[name].unit = unit;
  // Scenarios may declare other units.
  for (const auto& [column, unit] : units_of_columns(*store_)) known_[column].unit = unit;
  const inner::Model& model = *open->model;
  for (std::size_t k = 0; k < std::min(model.parameters.size(), model.parameter_units.size()); ++k)
    known_[model.parameters[k].name].meaning = model.parameters[k].doc;
}

}  // namespace anholon::v1
