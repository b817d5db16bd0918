#include "anholon/sweep.h"

#include <algorithm>
#include <limits>

#include "api/data.h"
#include "ensemble/request.h"

namespace anholon::v1 {

struct Sweep::Data {
  std::vector<std::string> names, columns;          // of what is varied, of the final state
  std::vector<std::vector<double>> varied, values;  // by name, by column
  std::vector<double> t;
  std::vector<Outcome> outcomes;
  Outcome outcome;
  std::size_t finished = 0;
};

namespace {

// Takes what a name varies. Throws Failure.
inner::Varied varied(const std::string& written, const inner::Model& model) {
  std::string name = written;
  unsigned order = 0;
  while (!name.empty() && name.back() == '\'') name.pop_back(), ++order;
  name = inner::normal_name(name);
  const std::vector<std::string>& q = model.names.coordinates;
  if (const auto it = std::find(q.begin(), q.end(), name); it != q.end()) {
    unsigned highest = 2;  // derivatives of this order follow from the state
    for (const inner::Constraint& c : model.constraints) highest = std::max(highest, static_cast<unsigned>(c.order));
    if (order >= highest) throw inner::Failure({}, written + " follows from the state", "vary " + name);
    return {inner::Varied::Kind::initial, static_cast<std::size_t>(it - q.begin()), order, written};
  }
  std::vector<std::string> known = q;
  for (std::size_t i = 0; i < model.parameters.size(); ++i) {
    if (model.parameters[i].name == name && order == 0) return {inner::Varied::Kind::parameter, i, 0, name};
    known.push_back(model.parameters[i].name);
  }
  const std::string near = inner::did_you_mean(name, known);
  throw inner::Failure({}, "there is no parameter and no coordinate '" + written + "'" +
                               (near.empty() ? "" : "; did you mean '" + near + "'?"));
}

// Puts each case into its place.
class CaseKeeper final : public inner::CaseSink {
 public:
  explicit CaseKeeper(Sweep::Data& data) : data_(data) {}
  void result(const inner::CaseResult& r) override {
    for (std::size_t k = 0; k < r.values.size(); ++k) data_.varied[k][r.number] = r.values[k];
    for (std::size_t k = 0; k < r.last.size(); ++k) data_.values[k][r.number] = r.last[k];
    data_.t[r.number] = r.t;
    data_.outcomes[r.number] = to_public(r.outcome);
    data_.finished += r.outcome.ok();
  }

 private:
  Sweep::Data& data_;
};

}  // namespace

std::vector<Number> linspace(double from, double to, std::size_t count) {
  std::vector<Number> list;
  for (std::size_t k = 0; k < count; ++k)
    list.emplace_back(count == 1 ? from : from + (to - from) * static_cast<double>(k) / static_cast<double>(count - 1));
  return list;
}

Result<Sweep> sweep(const System& system, const SweepOptions& asked) {
  constexpr std::size_t kMostCases = 100'000'000;
  const System::Data& of = system.data();
  return guarded(of.model->source, [&]() -> Result<Sweep> {
    const inner::Scenario& s = of.scenario;
    inner::EnsembleOptions o;
    o.state = of.choice;
    std::vector<std::vector<inner::Rational>> grid;
    o.cases = 1;
    auto data = std::make_shared<Sweep::Data>();
    for (const Vary& v : asked.vary) {
      o.varied.push_back(varied(v.name, *s.model));
      if (std::find(data->names.begin(), data->names.end(), v.name) != data->names.end())
        throw inner::Failure({}, "'" + v.name + "' is varied twice", "one entry of SweepOptions::vary for each name");
      if (v.values.empty()) throw inner::Failure({}, "'" + v.name + "' has no values to take");
      for (const inner::StateOverride& given : o.state.overrides)
        if (const inner::Varied& w = o.varied.back(); w.kind == inner::Varied::Kind::initial && !given.multiplier &&
                                                      given.coordinate == w.index && given.order == w.order)
          throw inner::Failure({}, "'" + v.name + "' is both given and varied");
      std::vector<inner::Rational>& values = grid.emplace_back();
      for (const Number& n : v.values) values.push_back(exact(n, v.name));
      if (values.size() > kMostCases / o.cases)
        throw inner::Failure({}, "the grid has more than " + std::to_string(kMostCases) + " cases", "fewer values");
      o.cases *= values.size();
      data->names.push_back(v.name);
    }
    if (asked.vary.empty()) throw inner::Failure({}, "nothing is varied", "SweepOptions::vary");
    o.numbers = [&grid](std::size_t number) {
      inner::EnsembleCase c;
      c.values.resize(grid.size());
      for (std::size_t k = grid.size(); k-- > 0; number /= grid[k].size())
        c.values[k] = grid[k][number % grid[k].size()];
      return c;
    };
    inner::MotionSettings settings;
    const auto number = [&](const char* name, const std::optional<Number>& given) {
      if (given)
        inner::set(settings, inner::motion_option(name), {given->text()}, name,
                   [&](const std::string& text) { return exact(Number(text), name); });
    };
    number("to", asked.to), number("tolerance", asked.tolerance);
    settings.error_estimate = "never";
    inner::ask(inner::merged(settings, s.model->simulate), s, {"", "", [](const std::string&) {}}, o);
    o.threads = asked.threads;
    o.cancelled = asked.cancelled;
    o.progress = asked.progress;
    data->columns = inner::ensemble_columns(*s.model);
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    data->varied.assign(data->names.size(), std::vector<double>(o.cases, nothing));
    data->values.assign(data->columns.size(), std::vector<double>(o.cases, nothing));
    data->t.assign(o.cases, nothing);
    data->outcomes.assign(o.cases, {OutcomeKind::interrupted, "the case was not computed", ""});
    CaseKeeper cases(*data);
    data->outcome = to_public(inner::ensemble(s, o, cases).outcome);
    return Sweep(std::move(data));
  });
}

std::size_t Sweep::cases() const { return data_->t.size(); }
std::size_t Sweep::finished() const { return data_->finished; }
const std::vector<std::string>& Sweep::columns() const { return data_->columns; }
std::span<const double> Sweep::t() const { return data_->t; }
const Outcome& Sweep::outcome(std::size_t number) const { return data_->outcomes.at(number); }
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
std::span<const double> Sweep::varied(const std::string& name) const {
  return named(name, data_->names, data_->varied);
}

}  // namespace anholon::v1
