#include "ensemble/table.h"

#include <algorithm>
#include <limits>

#include "ensemble/columns.h"

namespace anholon {

namespace {

using Holds = SweepColumn::Holds;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// The places of the first columns; what varies is between kCase and the others, which follow it in this order.
constexpr std::size_t kCase = 0, kOutcome = 0, kEvent = 1, kTime = 2, kSteps = 3, kBeforeState = 4;

}  // namespace

std::string units_of(const std::vector<Varied>& varied) {
  std::string units;
  for (const Varied& v : varied)
    if (!v.unit.name.empty()) units += (units.empty() ? "" : ", ") + v.name + " in " + v.unit.name;
  return units;
}

SweepTable::SweepTable(const Model& model, const EnsembleOptions& o)
    : varied_(o.varied.size()), state_(0), reduced_(o.reductions.list.size()), units_(units_of(o.varied)) {
  available_.push_back({"case", Holds::whole_numbers});
  // A varied initial value has a name that differs from the final value's.
  for (const Varied& v : o.varied)
    available_.push_back({v.kind == Varied::Kind::initial ? v.name + "(0)" : v.name, Holds::numbers});
  const std::size_t first = available_.size();
  available_.push_back({"outcome", Holds::words});
  available_.push_back({"event", Holds::words});
  available_.push_back({"t", Holds::numbers});
  available_.push_back({"steps", Holds::whole_numbers});
  for (const std::string& name : ensemble_columns(model)) available_.push_back({name, Holds::numbers}), ++state_;
  for (const std::string& name : o.own_columns) available_.push_back({name, Holds::numbers}), ++state_;
  for (const Reduction& r : o.reductions.list) available_.push_back({r.name, Holds::numbers});
  for (const Rational& t : o.at) times_.push_back(from_rational<double>(t));
  const bool ends = std::any_of(model.events.begin(), model.events.end(), [](const Event& e) { return e.stop; });
  for (std::size_t k = 0; k < available_.size(); ++k)
    if (k != first + kSteps && (k != first + kEvent || ends)) chosen_.push_back(k);
}

std::vector<SweepColumn> SweepTable::columns() const {
  std::vector<SweepColumn> list;
  for (std::size_t k : chosen_) list.push_back(available_[k]);
  if (named_) list.insert(list.begin() + 1, available_.back());
  return list;
}

void SweepTable::choose(const std::vector<std::size_t>& columns) {
  chooses_ = true;
  chosen_ = {kCase};
  const std::size_t time = 1 + varied_ + kTime;
  if (!times_.empty()) chosen_.push_back(time);
  const auto add = [&](std::size_t k) {
    if (std::find(chosen_.begin(), chosen_.end(), k) == chosen_.end()) chosen_.push_back(k);
  };
  for (std::size_t k = 1; k <= varied_; ++k)
    if (std::find(columns.begin(), columns.end(), k) == columns.end()) add(k);
  for (std::size_t k : columns) add(k);
  const std::size_t reductions = 1 + varied_ + kBeforeState + state_;
  for (std::size_t k = 0; k < reduced_; ++k) add(reductions + k);
}

void SweepTable::must_tell_columns_apart() const {
  const auto with_name = [](const std::vector<SweepColumn>& list, const std::string& name) {
    return std::count_if(list.begin(), list.end(), [&](const SweepColumn& c) { return c.name == name; });
  };
  const std::vector<SweepColumn> written = columns();
  for (const SweepColumn& c : written)
    // If columns were chosen by name, an ambiguous name among the available ones is an error, too.
    if (with_name(chooses_ ? available_ : written, c.name) > 1)
      throw Failure({}, "two columns of the sweep are called '" + c.name + "'",
                    "case, case_name, outcome, event, t and steps are columns of sweeps; another name in the model, or "
                    "--columns that leaves '" +
                        c.name + "' out");
}

void SweepTable::add_word(const std::string& name) {
  available_.push_back({name, Holds::words});
  named_ = true;
}

void SweepTable::fill(const CaseResult& r, double t, std::span<const double> state) {
  const std::size_t first = 1 + varied_;
  all_.assign(available_.size(), {kNone, {}});
  for (std::size_t k = 0; k < r.values.size(); ++k) all_[1 + k].number = r.values[k];
  all_[first + kOutcome].word = name(r.outcome.kind);
  all_[first + kEvent].word = r.event;
  all_[first + kTime].number = t;
  all_[first + kSteps].number = static_cast<double>(r.steps);
  for (std::size_t k = 0; k < state.size(); ++k) all_[first + kBeforeState + k].number = state[k];
  for (std::size_t k = 0; k < r.reduced.size(); ++k) all_[first + kBeforeState + state_ + k].number = r.reduced[k];
}

void SweepTable::rows(const CaseResult& r, std::size_t number, std::string_view word, const Take& take) {
  const auto give = [&](double t, std::span<const double> state) {
    fill(r, t, state);
    all_[kCase].number = static_cast<double>(number);
    cells_.clear();
    for (std::size_t k : chosen_) cells_.push_back(all_[k]);
    if (named_) cells_.insert(cells_.begin() + 1, {kNone, word});
    take(cells_);
  };
  if (times_.empty()) return give(r.t, r.last);
  for (const double t : times_) {
    const auto at = std::find_if(r.rows.begin(), r.rows.end(), [&](const auto& row) { return row[0] == t; });
    give(t, at == r.rows.end() ? std::span<const double>() : std::span(*at).subspan(1));
  }
}

}  // namespace anholon
