#include "linear/study.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "linear/equilibrium.h"
#include "linear/states_at_rest.h"
#include "model/exponents.h"
#include "setup/words/mistake_in_word.h"
#include "setup/words/value_range.h"

namespace anholon {

namespace {

constexpr std::size_t kMostValues = 10000;
constexpr int kWorkingDigits = 36, kGuardDigits = 24;  // 36: two words of 64 bits, with which MPFR is fastest

std::vector<std::complex<double>> spectrum(const LinearResult& r) {
  std::vector<std::complex<double>> list;
  if (r.outcome.ok())
    for (const Eigenvalue& e : r.model.spectrum) list.emplace_back(to_double(e.value.re), to_double(e.value.im));
  return list;
}

}  // namespace

std::size_t parameter_of(const Model& model, const std::string& name) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < model.parameters.size(); ++i) {
    if (model.parameters[i].name == name) return i;
    names.push_back(model.parameters[i].name);
  }
  const std::string near = did_you_mean(name, names);
  throw Failure({}, "there is no parameter '" + name + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"));
}

ParameterRange read_range(const std::string& word, const Model& model) {
  const std::size_t sign = word.find('=');
  if (sign == std::string::npos || sign == 0 || sign + 1 == word.size())
    mistake_in(word, 0, word.size(), "this is not of the form NAME=VALUES",
               "a range such as v=0..10:1 (step) or v=0:10:11 (how many), or values v=0,1,2");
  const std::string name = word.substr(0, sign);
  ParameterRange range;
  try {
    range.parameter = parameter_of(model, name);
  } catch (const Failure& f) {
    mistake_in(word, 0, sign, f.diagnostic.message, f.diagnostic.hint);
  }
  range.unit = declared_unit(model.parameters[range.parameter]);
  GivenQuantity of = GivenQuantity::of_parameter(model, range.parameter);
  const ValueRange values = read_value_range(word, sign, of, kMostValues);
  for (std::size_t k = 0; k < values.size(); ++k) range.values.push_back(values[k]);
  return range;
}

// Makes the scenario of the model. For an equilibrium, its states rest, too, where they can, and the coordinates that
// have no influence are held.
Outcome LinearStudy::make(const Model& model, Scenario& scenario) const {
  const std::shared_ptr<const Model> rests =
      request_.equilibrium ? with_states_at_rest(model, working_digits()) : nullptr;
  const std::shared_ptr<const Model> own = clone(rests ? *rests : model);
  const Outcome start = make_scenario(own, *request_.form, request_.choice, scenario);
  if (!request_.equilibrium || !start.ok()) return start;
  const std::vector<std::size_t> held = without_influence(scenario);
  if (held.empty()) return start;
  return make_scenario(held_at_start(*own, held), *request_.form, request_.choice, scenario);
}

LinearStudy::LinearStudy(std::shared_ptr<const Model> model, LinearRequest request) : request_(std::move(request)) {
  const std::size_t parameters = model->parameters.size();
  for (const StateVariable& z : model->states) states_.push_back(z.name);
  if (request_.equilibrium) model = at_rest(*model);
  model = with_signals(*model, signals_);
  if (request_.equilibrium) model = searched_from(*model, request_.choice);
  if (const auto d = not_integrated(*model)) throw Failure(*d);
  // Signals are varied, so they must not be substituted.
  request_.choice.open_parameters.emplace();
  for (std::size_t i = parameters; i < model->parameters.size(); ++i) request_.choice.open_parameters->push_back(i);
  model_ = model;
  start_ = make(*model_, scenario_);
  if (start_.ok() && !signals_.inputs.empty()) note_rates(scenario_, signals_);
}

int LinearStudy::working_digits() const { return std::max(kWorkingDigits, request_.digits + kGuardDigits); }

Linearization LinearStudy::compute() const {
  Linearization l;
  if (request_.range) {
    const ParameterRange& range = *request_.range;
    const ScenarioAt scenario_at = [&](const Rational& value, Scenario& scenario) {
      const std::shared_ptr<Model> model = clone(*model_);
      model->parameters[range.parameter].value = model->graph->number(range.unit.in_si(value));
      return make(*model, scenario);
    };
    const bool each_anew =
        (request_.equilibrium && !states_.empty()) || !exponents_of(*clone(*model_), {range.parameter}).empty();
    l = linearize(scenario_at, request_.choice, range, each_anew, signals_);
  } else if (start_.ok()) {
    l = linearize(scenario_, request_.choice, signals_);
  } else {
    l.results.push_back({"", start_, {}});
  }
  if (request_.equilibrium)
    for (LinearResult& r : l.results) say_no_rest(states_, r.outcome);
  return l;
}

std::vector<std::vector<std::complex<double>>> curves(const Linearization& l) {
  using Values = std::vector<std::complex<double>>;
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::size_t most = 0;
  for (const LinearResult& r : l.results) most = std::max(most, r.model.spectrum.size());
  std::vector<Values> list(most, Values(l.results.size(), {none, none}));
  Values last, before;  // for each curve, at the previous value and at the one before it
  for (std::size_t k = 0; k < l.results.size(); ++k) {
    const Values here = spectrum(l.results[k]);
    if (here.empty()) continue;
    if (last.empty()) last = here, last.resize(most, {none, none}), before = last;
    struct Pair {
      double distance;
      std::size_t curve, value;
    };
    std::vector<Pair> pairs;
    for (std::size_t c = 0; c < most; ++c)
      for (std::size_t i = 0; i < here.size(); ++i) {
        // The distance from the linear continuation of the curve.
        const double distance = std::abs(here[i] - (2.0 * last[c] - before[c]));
        pairs.push_back({std::isnan(distance) ? std::numeric_limits<double>::infinity() : distance, c, i});
      }
    std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
    std::vector<bool> curve_done(most), value_done(here.size());
    for (const Pair& p : pairs) {
      if (curve_done[p.curve] || value_done[p.value]) continue;
      curve_done[p.curve] = value_done[p.value] = true;
      list[p.curve][k] = here[p.value];
      before[p.curve] = std::isnan(last[p.curve].real()) ? here[p.value] : last[p.curve];
      last[p.curve] = here[p.value];
    }
  }
  return list;
}

}  // namespace anholon
