#include "anholon/sweep.h"

#include <algorithm>
#include <limits>

#include "api/sweep_request.h"

namespace anholon::v1 {

struct Sweep::Data {
  std::vector<std::string> names, columns;          // of what is varied; of the final state, then the reductions
  std::vector<std::vector<double>> varied, values;  // by name, by column
  std::size_t of_state = 0;                         // how many columns are no reductions
  std::vector<double> times;
  std::vector<std::vector<double>> rows;  // by column of the state: case by case, at the times
  std::vector<double> t;
  std::vector<Outcome> outcomes;
  std::vector<std::string> events;  // empty if none has ended a motion
  std::vector<std::size_t> steps;
  Outcome outcome;
  std::size_t finished = 0;
};

namespace {

// Puts each case into its place.
class CaseKeeper final : public inner::CaseSink {
 public:
  CaseKeeper(Sweep::Data& data, const std::vector<std::string>& of_state, const inner::Reductions& reductions,
             const std::vector<std::string>& columns)
      : data_(data), in_state_(of_state.size()) {
    std::vector<std::string> all = of_state;
    for (const inner::Reduction& r : reductions.list) all.push_back(r.name);
    places_ = chosen_places(columns, all);
    for (std::size_t k : places_) {
      data_.columns.push_back(all[k]);
      data_.of_state += k < in_state_;
    }
  }
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
    for (std::size_t k = 0; k < r.values.size(); ++k) data_.varied[k][r.number] = r.values[k];
    for (std::size_t k = 0; k < places_.size(); ++k) {
      const std::size_t place = places_[k];
      const std::vector<double>& from = place < in_state_ ? r.last : r.reduced;
      const std::size_t at = place < in_state_ ? place : place - in_state_;
      if (at < from.size()) data_.values[k][r.number] = from[at];
    }
    const std::size_t times = data_.times.size();
    for (const std::vector<double>& row : r.rows) {
      const auto at = std::find(data_.times.begin(), data_.times.end(), row[0]);
      if (at == data_.times.end()) continue;
      const auto time = static_cast<std::size_t>(at - data_.times.begin());
      for (std::size_t k = 0; k < data_.of_state; ++k) data_.rows[k][r.number * times + time] = row[1 + places_[k]];
    }
    data_.t[r.number] = r.t;
    data_.steps[r.number] = r.steps;
    data_.outcomes[r.number] = to_public(r.outcome);
    if (!r.event.empty()) {
      data_.events.resize(data_.t.size());
      data_.events[r.number] = r.event;
    }
    data_.finished += r.outcome.ok();
  }

 private:
  Sweep::Data& data_;
  std::size_t in_state_;
  std::vector<std::size_t> places_;  // of the columns
};

}  // namespace

std::vector<Number> linspace(double from, double to, std::size_t count) {
  std::vector<Number> list;
  for (std::size_t k = 0; k < count; ++k)
    list.emplace_back(count == 1 ? from : from + (to - from) * static_cast<double>(k) / static_cast<double>(count - 1));
  return list;
}

Result<Sweep> sweep(const System& system, const SweepOptions& asked) {
  const System::Data& of = system.data();
  return guarded(of.model->source, [&]() -> Result<Sweep> {
    constexpr std::size_t kMostCases = 100'000'000;  // all of them are held in memory
    PreparedSweep p(of, asked);
    if (!p.start.ok()) return error_of(p.start);
    inner::EnsembleOptions& o = p.options;
    if (o.cases > kMostCases)
      throw inner::Failure({}, "the sweep has more than " + std::to_string(kMostCases) + " cases",
                           "fewer values, or a sweep in a folder");
    auto data = std::make_shared<Sweep::Data>();
    for (const Vary& v : asked.vary) data->names.push_back(v.name);
    o.cancelled = asked.cancelled;
    o.progress = asked.progress;
    for (const inner::Rational& t : o.at) data->times.push_back(inner::from_rational<double>(t));
    std::vector<std::string> names = inner::ensemble_columns(*p.scenario->model);
    names.insert(names.end(), o.own_columns.begin(), o.own_columns.end());
    CaseKeeper cases(*data, names, o.reductions, asked.columns);
    cases.hold(o.cases);
    data->outcome = to_public(inner::ensemble(*p.scenario, o, cases).outcome);
    return Sweep(std::move(data));
  });
}

std::size_t Sweep::cases() const { return data_->t.size(); }
std::size_t Sweep::finished() const { return data_->finished; }
const std::vector<std::string>& Sweep::columns() const { return data_->columns; }
std::span<const double> Sweep::t() const { return data_->t; }
const Outcome& Sweep::outcome(std::size_t number) const { return data_->outcomes.at(number); }
const std::string& Sweep::event(std::size_t number) const {
  static const std::string none;
  return data_->events.empty() ? none : data_->events.at(number);
}
std::size_t Sweep::steps(std::size_t number) const { return data_->steps.at(number); }
const std::vector<double>& Sweep::times() const { return data_->times; }
const Outcome& Sweep::outcome() const { return data_->outcome; }

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
