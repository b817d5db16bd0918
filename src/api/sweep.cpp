#include "anholon/sweep.h"

#include <algorithm>
#include <limits>

#include "api/data.h"
#include "ensemble/request.h"
#include "ensemble/variation.h"

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

// What varies, from the options. Throws Failure.
inner::Variation variation_of(const SweepOptions& asked, const inner::Model& model) {
  constexpr std::size_t kMostCases = 100'000'000;  // all of them are held in memory
  inner::Variation v(asked.seed);
  try {
    for (const Vary& each : asked.vary) {
      if (!each.law.empty()) {
        v.add(each.name + "~" + each.law, model);
        continue;
      }
      std::vector<inner::Rational> values;
      for (const Number& n : each.values) values.push_back(exact(n, each.name));
      v.add(each.name, std::move(values), model);
    }
  } catch (const inner::VariationMistake& m) {
    throw inner::Failure({}, "vary " + m.word + ": " + m.diagnostic.message, m.diagnostic.hint);
  }
  v.finish(asked.cases, "SweepOptions::cases");
  if (v.cases() > kMostCases)
    throw inner::Failure({}, "the sweep has more than " + std::to_string(kMostCases) + " cases", "fewer values");
  return v;
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
  const System::Data& of = system.data();
  return guarded(of.model->source, [&]() -> Result<Sweep> {
    const inner::Scenario& s = of.scenario;
    inner::EnsembleOptions o;
    o.state = of.choice;
    const inner::Variation variation = variation_of(asked, *s.model);
    must_not_be_given(variation.varied(), o.state);
    o.varied = variation.varied();
    o.cases = variation.cases();
    o.numbers = [&variation](std::size_t number) { return inner::EnsembleCase{variation(number), {}}; };
    auto data = std::make_shared<Sweep::Data>();
    for (const Vary& v : asked.vary) data->names.push_back(v.name);
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
