#include "anholon/sweep.h"

#include <algorithm>
#include <limits>

#include "api/sweep_data.h"
#include "api/sweep_request.h"
#include "base/escape.h"
#include "base/read_file.h"
#include "ensemble/parts/judgement.h"
#include "ensemble/parts/scenarios.h"
#include "ensemble/reduce/reduction_notes.h"
#include "observe/rows/quantity_units.h"

namespace anholon::v1 {

namespace {

// The columns of a piece that are kept.
struct KeptColumns {
  KeptColumns(const PreparedPiece& piece, const std::vector<std::string>& asked) {
    std::vector<std::string> all = inner::ensemble_columns(*piece.scenario->model);
    all.insert(all.end(), piece.options.own_columns.begin(), piece.options.own_columns.end());
    in_state = all.size();
    for (const inner::Reduction& r : piece.options.reductions.list) all.push_back(r.name);
    places = chosen_places(asked, all);
    for (std::size_t k = in_state; k < all.size(); ++k)
      if (std::find(places.begin(), places.end(), k) == places.end()) places.push_back(k);
    std::sort(places.begin(), places.end());
    for (const std::size_t k : places) {
      names.push_back(all[k]);
      of_state += k < in_state;
    }
  }
  std::vector<std::string> names;
  std::vector<std::size_t> places;  // among those of the state, then the reductions
  std::size_t in_state = 0;         // the number of columns of the state
  std::size_t of_state = 0;         // the number of kept columns that belong to the state
};

// Puts each case into its place.
class CaseKeeper final : public inner::CaseSink {
 public:
  explicit CaseKeeper(Sweep::Data& data) : data_(data) {}
  // Announces the cases of a piece with these columns; their numbers are counted from `before`.
  void turn_to(const KeptColumns& columns, std::size_t before) { columns_ = &columns, before_ = before; }
  // Makes room for the cases.
  void hold(std::size_t cases) {
    constexpr double kMostNumbers = 2e9;
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    const std::size_t times = data_.times.size();
    if (static_cast<double>(cases) * static_cast<double>(data_.of_state * times + data_.columns.size()) > kMostNumbers)
      throw inner::Failure({}, "the sweep has more than 2e9 numbers", "fewer columns, times or cases");
    data_.varied.assign(data_.names.size(), std::vector<double>(cases, nothing));
    data_.values.assign(data_.columns.size(), std::vector<double>(cases, nothing));
    data_.rows.assign(times > 0 ? data_.of_state : 0, std::vector<double>(cases * times, nothing));
    data_.t.assign(cases, nothing);
    data_.steps.assign(cases, 0);
    data_.outcomes.assign(cases, {OutcomeKind::interrupted, "the case was not computed", ""});
  }
  void result(const inner::CaseResult& r) override {
    const std::size_t number = before_ + r.number, in_state = columns_->in_state;
    for (std::size_t k = 0; k < r.values.size(); ++k) data_.varied[k][number] = r.values[k];
    for (std::size_t k = 0; k < columns_->places.size(); ++k) {
      const std::size_t place = columns_->places[k];
      const std::vector<double>& from = place < in_state ? r.last : r.reduced;
      const std::size_t at = place < in_state ? place : place - in_state;
      if (at < from.size()) data_.values[k][number] = from[at];
    }
    const std::size_t times = data_.times.size();
    for (const std::vector<double>& row : r.rows) {
      const auto at = std::find(data_.times.begin(), data_.times.end(), row[0]);
      if (at == data_.times.end()) continue;
      const auto time = static_cast<std::size_t>(at - data_.times.begin());
      for (std::size_t k = 0; k < data_.of_state; ++k)
        data_.rows[k][number * times + time] = row[1 + columns_->places[k]];
    }
    data_.t[number] = r.t;
    data_.steps[number] = r.steps;
    data_.outcomes[number] = to_public(r.outcome);
    inner::count_stopped(data_.stopped, number, r.outcome);
    if (!r.event.empty()) {
      data_.events.resize(data_.t.size());
      data_.events[number] = r.event;
    }
    data_.finished += r.outcome.ok();
  }

 private:
  Sweep::Data& data_;
  const KeptColumns* columns_ = nullptr;
  std::size_t before_ = 0;
};

// Returns the table in which the command line writes the cases.
inner::SweepTable table_of(const PreparedPiece& piece, const KeptColumns& columns, bool chosen) {
  inner::SweepTable table(*piece.scenario->model, piece.options);
  if (chosen) {
    // The case, the varied values, the outcome, the event, t and the steps stand before the state.
    const std::size_t outcome = 1 + piece.options.varied.size();
    const bool ends = table.columns().at(outcome + 1).name == "event";
    std::vector<std::size_t> list;
    for (std::size_t k = 1; k <= outcome; ++k) list.push_back(k);
    if (ends) list.push_back(outcome + 1);
    list.push_back(outcome + 2);
    for (const std::size_t place : columns.places) list.push_back(outcome + 4 + place);
    table.choose(list);
  }
  if (!piece.word.empty()) table.add_word("case_name");
  return table;
}

// Returns the units of the time, of columns and of varied values, as far as the model tells them.
std::map<std::string, std::string> units_of(const Model::Data& model, const Sweep::Data& d) {
  std::map<std::string, std::string> units = inner::quantity_units(*model.model, model.contacts);
  const auto is_in = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  std::erase_if(units, [&](const auto& unit) {
    return unit.first != "t" && !is_in(d.columns, unit.first) && !is_in(d.names, unit.first);
  });
  return units;
}

// Computes the cases of all pieces, one piece after the other.
Result<Sweep> computed(const PreparedSweep& p) {
  constexpr std::size_t kMostCases = 100'000'000;  // all of them are held in memory
  if (p.cases > kMostCases)
    throw inner::Failure({}, "the sweep has more than " + std::to_string(kMostCases) + " cases",
                         "fewer values, or a sweep in a folder");
  auto data = std::make_shared<Sweep::Data>();
  data->scenarios = p.scenarios;
  for (const Vary& v : p.asked.vary) data->names.push_back(v.name);
  const std::vector<inner::Varied>& varied = p.pieces.front().options.varied;
  for (std::size_t k = data->names.size(); k < varied.size(); ++k) data->names.push_back(varied[k].name);
  for (const inner::Rational& t : p.pieces.front().options.at) data->times.push_back(inner::from_rational<double>(t));
  std::vector<KeptColumns> columns;
  for (const PreparedPiece& piece : p.pieces) {
    columns.emplace_back(piece, p.asked.columns);
    if (columns.back().names != columns.front().names)
      inner::has_other_columns(piece.word, p.pieces.front().word, "choose columns that both have");
    inner::must_have_units_of(inner::units_of(p.pieces.front().options.varied), p.pieces.front().word,
                              inner::units_of(piece.options.varied), piece.word);
  }
  const PreparedPiece& first = p.pieces.front();
  data->columns = columns.front().names, data->of_state = columns.front().of_state;
  data->model = p.model, data->form = first.scenario->system.form->name,
  data->units = units_of(*first.system.data().model, *data);
  data->table = table_of(first, columns.front(), !p.asked.columns.empty());
  data->places = columns.front().places;
  data->all_of_state = columns.front().in_state, data->all_reductions = first.options.reductions.list.size();
  CaseKeeper cases(*data);
  cases.hold(p.cases);
  std::size_t before = 0;
  for (std::size_t k = 0; k < p.pieces.size() && data->outcome.ok(); ++k) {
    const PreparedPiece& piece = p.pieces[k];
    inner::EnsembleOptions o = piece.options;
    o.cancelled = p.asked.cancelled;
    if (p.asked.progress) o.progress = [&](std::size_t done) { p.asked.progress(before + done); };
    cases.turn_to(columns[k], before);
    const inner::EnsembleReport report = inner::ensemble(*piece.scenario, o, cases);
    inner::add_report(data->report, report);
    data->outcome = to_public(report.outcome);
    before += piece.options.cases;
  }
  data->notes = inner::notes_on_cases(data->report, {});
  for (const PreparedPiece& piece : p.pieces)
    for (std::string& text : inner::notes_of_formulas(*piece.scenario, piece.options.reductions))
      if (std::find(data->notes.begin(), data->notes.end(), text) == data->notes.end())
        data->notes.push_back(std::move(text));
  for (const auto& [kind, stopped] : data->stopped) data->notes.push_back(inner::stopped_note(kind, stopped));
  return Sweep(std::move(data));
}

}  // namespace

std::vector<Number> linspace(double from, double to, std::size_t count) {
  std::vector<Number> list;
  for (std::size_t k = 0; k < count; ++k)
    list.emplace_back(count == 1 ? from : from + (to - from) * static_cast<double>(k) / static_cast<double>(count - 1));
  return list;
}

Result<std::string> case_table(const std::string& path) {
  return guarded(inner::SourceText(), [&]() -> Result<std::string> {
    std::string text, why;
    if (!inner::read_file(path, text, &why))
      throw inner::Failure({}, "cannot read " + path + ": " + why,
                           "a CSV or Parquet file whose columns have the names of what varies");
    std::string table = inner::text_of_case_table(std::move(text), path);
    if (inner::hdf5_text(table) != table)
      throw inner::Failure({}, path + " holds bytes that are not UTF-8", "a table of numbers and formulas");
    return table;
  });
}

Result<Sweep> sweep(const System& system, const SweepOptions& asked) {
  const auto prepared = prepared_sweep(system, asked);
  if (!prepared) return prepared.error();
  return guarded(system.data().model->source, [&] { return computed(**prepared); });
}

Result<Sweep> sweep(const Model& model, const SweepOptions& asked, const PrepareOptions& prepare) {
  const auto prepared = prepared_sweep(model, prepare, asked);
  if (!prepared) return prepared.error();
  return guarded(model.data().source, [&] { return computed(**prepared); });
}

std::size_t Sweep::cases() const { return data_->t.size(); }
std::size_t Sweep::finished() const { return data_->finished; }
const std::vector<std::string>& Sweep::columns() const { return data_->columns; }
const std::vector<std::string>& Sweep::varied_names() const { return data_->names; }
const std::vector<std::string>& Sweep::scenarios() const { return data_->scenarios; }
const std::string& Sweep::scenario(std::size_t number) const {
  static const std::string none;
  return data_->scenarios.empty() ? none : data_->scenarios.at(number / (cases() / data_->scenarios.size()));
}
std::span<const double> Sweep::t() const { return data_->t; }
const Outcome& Sweep::outcome(std::size_t number) const { return data_->outcomes.at(number); }
const std::string& Sweep::event(std::size_t number) const {
  static const std::string none;
  return data_->events.empty() ? none : data_->events.at(number);
}
std::size_t Sweep::steps(std::size_t number) const { return data_->steps.at(number); }
const std::vector<double>& Sweep::times() const { return data_->times; }
const Outcome& Sweep::outcome() const { return data_->outcome; }
const std::vector<std::string>& Sweep::notes() const { return data_->notes; }
const std::map<std::string, std::string>& Sweep::units() const { return data_->units; }

static std::span<const double> named(const std::string& name, const std::vector<std::string>& names,
                                     const std::vector<std::vector<double>>& values) {
  const auto it = std::find(names.begin(), names.end(), name);
  if (it == names.end()) return {};
  return values[static_cast<std::size_t>(it - names.begin())];
}

std::span<const double> Sweep::column(const std::string& name) const {
  return named(name, data_->columns, data_->values);
}
std::span<const double> Sweep::rows(const std::string& name) const {
  return named(name, {data_->columns.begin(), data_->columns.begin() + static_cast<std::ptrdiff_t>(data_->rows.size())},
               data_->rows);
}
std::span<const double> Sweep::varied(const std::string& name) const {
  return named(name, data_->names, data_->varied);
}

}  // namespace anholon::v1
