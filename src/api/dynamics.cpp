#include "anholon/dynamics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "api/dynamics_data.h"
#include "contact/mode/switched_model.h"
#include "setup/inputs.h"
#include "setup/outputs/chosen_outputs.h"

namespace anholon::v1 {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Calls f(), which computes these numbers. If a StopRequest ends f, sets the numbers to NaN if the caller asks for NaN;
// throws on otherwise.
template <class F>
static void or_stopped(std::span<double> numbers, const Dynamics::Given& given, const F& f) {
  try {
    f();
  } catch (const inner::StopRequested&) {
    if (given.nan_if_stopped) std::fill(numbers.begin(), numbers.end(), std::numeric_limits<double>::quiet_NaN());
  }
}

// Returns the model with the outputs that are asked for. Throws Failure.
static Result<std::shared_ptr<const inner::Model>> model_of(const Dynamics::Data& data) {
  const Model::Data& of = *data.system.data().model;
  if (!data.options.outputs) return of.model;
  inner::Diagnostics diagnostics;
  const auto open = of.open_again(diagnostics);
  if (!open) return error_of(diagnostics, of.source);
  std::vector<inner::ChosenOutput> outputs;
  for (const DynamicsOptions::Output& o : *data.options.outputs) outputs.push_back({o.name, o.formula});
  return inner::with_outputs(*open, outputs);
}

// Prepares a system of whose model exponents alone are others than in a system that has a start: if exponents that are
// no numbers leave it without one, the structure and the start are those of the other system.
static std::optional<Error> prepared(std::shared_ptr<const inner::Model> model, const std::string& form,
                                     const inner::StateChoice& choice, const inner::Scenario* like,
                                     inner::Scenario& scenario) {
  const inner::Outcome o = make_system(std::move(model), form, choice, scenario);
  if (o.ok()) return std::nullopt;
  if (!like || scenario.system.variable_names != like->system.variable_names ||
      scenario.independent != like->independent)
    return error_of(o);
  scenario.structure = like->structure;
  scenario.state = like->state;
  return std::nullopt;
}

// Makes the scenario of a function. Parameters have the values data.put_in, and whole exponents that follow from them
// alone are numbers. `like`: the function for other exponents; nullptr if the model's own ones are put in. Throws
// Failure.
static std::optional<Error> open_scenario(Dynamics::Data& data, const Dynamics::Data* like) {
  const System::Data& of = data.system.data();
  const std::string form = of.scenario.system.form->name;
  inner::StateChoice choice = of.choice;
  auto model = model_of(data);
  if (!model) return model.error();
  if (like) {
    choice.open_parameters = like->exponents.others(data.put_in);
    *model = inner::with_values(**model, data.put_in);
  } else {
    data.exponents = inner::ExponentValues(**model);
  }
  if (like || data.options.outputs) {
    if (const auto fault = prepared(*model, form, choice, like ? like->scenario : nullptr, data.opened)) return fault;
    data.scenario = &data.opened;
  }
  if (!data.options.inputs && data.options.input_names.empty()) return std::nullopt;
  const inner::InputsAsParameters inputs = inner::inputs_as_parameters(*data.scenario, data.options.input_names);
  if (data.options.outputs && !inputs.left_out.empty())
    return mistake("the output '" + inputs.left_out[0] + "' holds the rate of an input, which is no argument",
                   "leave the output out, or the input among the arguments");
  data.inputs = inputs.names, data.formulas = inputs.formulas, data.open = inputs.open_formulas;
  choice.open_parameters.reset();  // the exponents that remain are no numbers
  inner::Scenario opened;
  if (const auto fault = prepared(inputs.model, form, choice, like ? like->scenario : nullptr, opened)) return fault;
  data.opened = std::move(opened);
  data.scenario = &data.opened;
  return std::nullopt;
}

// Makes the function of the scenario. Returns false if there is none; data.obstacle tells why.
static bool make_function(Dynamics::Data& data) {
  inner::Workspace s(*data.scenario);
  inner::StateChoice choice = data.system.data().choice;
  choice.open_parameters.reset();
  const std::vector<std::size_t> fixed =
      inner::switching_parameters(*data.scenario->model, data.system.data().model->contacts_of_file);
  data.function = inner::Dynamics::make(s, choice, {data.options.minimal, data.inputs.size(), fixed}, data.obstacle);
  if (!data.function) return false;
  for (const inner::Dynamics::State& state : data.function->states())
    data.states.push_back({state.name, state.meaning});
  return true;
}

// Says what the equations are not solved for: a clause that follows a colon; empty if it is clear.
static std::string not_solved_for(const Dynamics::Data& data) {
  if (!data.scenario->redundant.empty())
    return ": the constraints depend on one another, so that the equations do not determine their multipliers";
  return data.function->minimal()
             ? ": in independent velocities these are multipliers and derivatives beyond accelerations"
             : "";
}

Result<Dynamics> dynamics(const System& system, const DynamicsOptions& options) {
  const System::Data& of = system.data();
  return guarded(of.model->source, [&]() -> Result<Dynamics> {
    of.model->without_contacts("dynamics");
    auto data = std::make_shared<Dynamics::Data>(system, options);
    if (const auto fault = open_scenario(*data, nullptr)) return *fault;
    if (!make_function(*data))
      return mistake("there is no function x' = f(t, x) of these equations: " + data->obstacle,
                     data->scenario->elimination.pivots().empty()
                         ? "another start may have one: give other initial values, in Python dynamics(initial={…})"
                         : "simulate integrates them all the same");
    data->put_in = data->exponents.whole(data->parameters({}));
    if (options.outputs && !data->values().formulas().left_out.empty())
      return mistake("the output '" + data->values().formulas().left_out[0] +
                         "' holds what the equations are not solved for" + not_solved_for(*data),
                     data->function->minimal() && data->scenario->redundant.empty()
                         ? "take all velocities, minimal=False, for multipliers; leave out derivatives beyond "
                           "accelerations"
                         : "leave it out");
    return Dynamics(data);
  });
}

std::shared_ptr<const Dynamics::Data>
Dynamics::Data::with_exponents(const inner::ExponentValues::Values& values) const {
  auto made = std::make_shared<Data>(system, options);
  made->put_in = values;
  try {
    if (open_scenario(*made, this) || !make_function(*made)) return nullptr;
  } catch (const inner::Failure&) {
    return nullptr;
  }
  const auto name = [](const StateName& of) { return of.name; };
  const bool fits = std::ranges::equal(states, made->states, {}, name, name) && made->inputs == inputs &&
                    made->function->free_parameters() == function->free_parameters() && same_velocities(*made);
  return fits ? made : nullptr;
}

bool Dynamics::Data::same_velocities(const Data& made) const {
  // These formulas differ by round-off of numbers of size 1 if they are the same.
  constexpr double kRoundOff = 1e-9;
  const auto meaning = [](const StateName& of) { return of.meaning; };
  if (std::ranges::equal(states, made.states, {}, meaning, meaning)) return true;
  // The formulas hold exponents. Those with parameters as exponents have to give the same velocities.
  const Data* general = made.put_in.empty() ? &made : found({});
  const Data& other = made.put_in.empty() ? *this : made;
  if (!general) return false;
  std::vector<double> p;
  for (const std::size_t i : function->free_parameters()) {
    const auto value = made.put_in.find(i);
    p.push_back(value == made.put_in.end() ? static_cast<double>(function->parameters()[i]) : value->second);
  }
  const double t = function->start_time();
  auto [q, qd, z] = function->to_motion(t, function->start());
  for (int k = 0; k < 3; ++k) {
    const std::vector<double> a = general->function->from_motion(t, q, qd, z, p),
                              b = other.function->from_motion(t, q, qd, z, p);
    for (std::size_t i = 0; i < a.size(); ++i)
      if (!(std::abs(a[i] - b[i]) <= kRoundOff * (1 + std::abs(a[i])))) return false;
    for (std::size_t i = 0; i < qd.size(); ++i) qd[i] += std::sin(static_cast<double>(i) + k + 1);
  }
  return true;
}

const Dynamics::Data* Dynamics::Data::at(std::span<const double> p) const {
  if (!exponents.any() || p.empty()) return this;
  const inner::ExponentValues::Values wanted = exponents.whole(parameters(p));
  const Data* found = for_exponents(wanted);
  return found || wanted.empty() ? found : for_exponents({});
}

const Dynamics::Data* Dynamics::Data::for_exponents(const inner::ExponentValues::Values& wanted) const {
  if (wanted == put_in) return this;
  const std::lock_guard lock(mutex_);
  return found(wanted);
}

const Dynamics::Data* Dynamics::Data::found(const inner::ExponentValues::Values& wanted) const {
  if (wanted == put_in) return this;
  const auto known = others_.find(wanted);
  if (known != others_.end()) return known->second.get();
  if (others_.size() >= kMostExponents && !wanted.empty()) return nullptr;
  const std::shared_ptr<const Data> made = with_exponents(wanted);
  return others_.emplace(wanted, made).first->second.get();
}

std::string
Dynamics::Data::text_with_exponents(const std::function<std::string(const inner::RateFormulas&)>& text) const {
  const std::lock_guard lock(mutex_);
  if (!with_exponents_) {
    Data made(system, options);
    try {
      if (!open_scenario(made, this)) {
        inner::Workspace own(*made.scenario);
        with_exponents_ =
            std::make_unique<inner::RateFormulas>(inner::rate_formulas_of(own, *function, made.formulas, made.open));
      }
    } catch (const inner::Failure&) {
    }
  }
  if (!with_exponents_)
    throw std::domain_error(
        "a power with a parameter in its exponent has no value at the start, where the equations need one for formulas "
        "that hold for all parameters\nhint: give a start at which its base is positive, in Python "
        "dynamics(initial={…})");
  return text(*with_exponents_);
}

const std::vector<StateName>& Dynamics::states() const { return data_->states; }
std::vector<std::string> Dynamics::inputs() const { return data_->inputs; }
std::vector<std::string> Dynamics::outputs() const { return data_->values().formulas().output_names; }
bool Dynamics::minimal() const { return data_->function->minimal(); }
const std::string& Dynamics::obstacle() const { return data_->obstacle; }
double Dynamics::start_time() const { return data_->function->start_time(); }
const std::vector<double>& Dynamics::start() const { return data_->function->start(); }

std::vector<std::string> Dynamics::parameters() const {
  std::vector<std::string> names;
  for (const std::size_t i : data_->function->free_parameters())
    names.push_back(data_->scenario->model->parameters[i].name);
  return names;
}

std::vector<double> Dynamics::parameter_values() const {
  std::vector<double> values;
  for (const std::size_t i : data_->function->free_parameters())
    values.push_back(static_cast<double>(data_->function->parameters()[i]));
  return values;
}

std::vector<double> Dynamics::start_inputs() const {
  const std::vector<long double>& all = data_->function->parameters();
  return {all.end() - static_cast<std::ptrdiff_t>(data_->inputs.size()), all.end()};
}

void Dynamics::rates(double t, std::span<const double> x, std::size_t count, std::span<double> rates,
                     const Given& given) const {
  or_stopped(rates, given, [&] {
    if (!data_->exponents.any()) return data_->rates(t, x, count, rates, given);
    data_->by_exponents({t, x, count, given}, data_->states.size(), rates,
                        [](const Data& data, const Data::Batch& batch, std::span<double> out) {
                          data.rates(batch.t, batch.x, batch.count, out, batch.given);
                        });
  });
}

void Dynamics::Data::rates(double t, std::span<const double> x, std::size_t count, std::span<double> rates,
                           const Given& given) const {
  inner::InputsAndParameters numbers{given.u, given.p};
  std::vector<double> u;
  if (given.u.empty() && !inputs.empty() && count > 0) {
    // The formulas of the model give the inputs, state by state.
    const std::size_t parameters = function->free_parameters().size();
    u.resize(inputs.size() * count);
    std::vector<double> state(states.size()), p(given.p.empty() ? 0 : parameters);
    for (std::size_t k = 0; k < count; ++k) {
      if (k % kStatesAtOnce == 0) inner::look_for_stop();
      for (std::size_t i = 0; i < state.size(); ++i) state[i] = x[i * count + k];
      for (std::size_t i = 0; i < p.size(); ++i) p[i] = given.p[given.p.size() == parameters ? i : i * count + k];
      const std::vector<double> of_state = given_inputs(t, state, {{}, p});
      for (std::size_t i = 0; i < inputs.size(); ++i) u[i * count + k] = of_state[i];
    }
    numbers.u = u;
  }
  function->rates(t, x.data(), count, rates.data(), numbers);
}

std::vector<double> Dynamics::inputs(double t, const std::vector<double>& x, std::span<const double> p) const {
  const Data* data = data_->at(p);
  return data ? data->given_inputs(t, x, {{}, p}) : std::vector<double>(inputs().size(), kNone);
}

std::vector<double> Dynamics::inputs(double t, const std::vector<double>& x, std::span<const double> p,
                                     std::span<const std::optional<double>> given) const {
  if (inputs().empty()) return {};
  const Data* data = data_->at(p);
  return data ? data->values().inputs({t, x, data->parameters(p), {}}, given)
              : std::vector<double>(inputs().size(), kNone);
}

std::vector<double> Dynamics::outputs(double t, std::span<const double> x, std::size_t count,
                                      const Given& given) const {
  std::vector<double> out(outputs().size() * count);
  const auto of_batch = [](const Data& data, const Data::Batch& batch, std::span<double> numbers) {
    data.in_points(batch, true, [&](std::size_t first, std::span<const inner::FormulaPoint> points) {
      const std::vector<double> y = data.values().outputs(points);
      const std::size_t size = y.size() / points.size();
      for (std::size_t k = 0; k < points.size(); ++k)
        for (std::size_t i = 0; i < size; ++i) numbers[i * batch.count + first + k] = y[k * size + i];
    });
  };
  or_stopped(out, given, [&] { data_->by_exponents({t, x, count, given}, outputs().size(), out, of_batch); });
  return out;
}

Dynamics::Jacobian Dynamics::jacobian(double t, std::span<const double> x, std::size_t count, const Given& given,
                                      By by) const {
  const inner::RateFormulas& f = data_->values().formulas();
  const std::size_t columns = by == By::state ? f.x.size() : by == By::input ? f.u.size() : f.p.size();
  Jacobian out{f.rates.size() + f.outputs.size(), columns, {}};
  const std::size_t rows = out.rows;
  out.values.resize(rows * columns * count);
  const auto of_function = [&](const Data& data, const Data::Batch& batch, std::span<double> numbers) {
    data.in_points(batch, true, [&](std::size_t first, std::span<const inner::FormulaPoint> points) {
      const auto all = data.values().derivatives(points, static_cast<inner::FormulaValues::By>(by));
      for (std::size_t k = 0; k < all.size(); ++k)
        for (std::size_t i = 0; i < all[k].values.size(); ++i) numbers[i * batch.count + first + k] = all[k].values[i];
    });
  };
  const auto of_batch = [&](const Data& data, const Data::Batch& batch, std::span<double> numbers) {
    of_function(data, batch, numbers);
    if (by != By::parameter || data.put_in.empty()) return;
    // The exponents vary with these parameters: their columns are those of the function for all exponents.
    std::vector<double> others(numbers.size(), kNone);
    if (const Data* general = data_->for_exponents({})) of_function(*general, batch, others);
    const std::vector<std::size_t>& p = data.function->free_parameters();
    for (std::size_t j = 0; j < columns; ++j)
      if (data.put_in.count(p[j]) > 0)
        for (std::size_t i = 0; i < rows; ++i)
          std::copy_n(&others[(i * columns + j) * batch.count], batch.count, &numbers[(i * columns + j) * batch.count]);
  };
  or_stopped(out.values, given,
             [&] { data_->by_exponents({t, x, count, given}, rows * columns, out.values, of_batch); });
  return out;
}

Dynamics::Equations Dynamics::equations(double t, std::span<const double> x, std::size_t count,
                                        const Given& given) const {
  const std::vector<std::string>& unknowns = data_->values().formulas().lead.names;
  const std::size_t n = unknowns.size();
  std::vector<double> both(n * (n + 1) * count);
  const auto of_batch = [n](const Data& data, const Data::Batch& batch, std::span<double> numbers) {
    data.in_points(batch, false, [&](std::size_t first, std::span<const inner::FormulaPoint> points) {
      const std::vector<double> values = data.values().equations(points);
      for (std::size_t k = 0; k < points.size(); ++k)
        for (std::size_t i = 0; i < n * (n + 1); ++i)
          numbers[i * batch.count + first + k] = values[k * n * (n + 1) + i];
    });
  };
  or_stopped(both, given, [&] { data_->by_exponents({t, x, count, given}, n * (n + 1), both, of_batch); });
  const auto right = both.begin() + static_cast<std::ptrdiff_t>(n * n * count);
  return {unknowns, {both.begin(), right}, {right, both.end()}};
}

bool Dynamics::linear() const { return data_->function->linear(); }

std::vector<double> Dynamics::leading(double t, const std::vector<double>& x, const Given& given) const {
  const Data* data = data_->at(given.p);
  return data ? data->points({t, x, 1, given}, 0, 1, true).lead
              : std::vector<double>(data_->values().formulas().lead.size(), kNone);
}

std::string Dynamics::source(Source kind, const std::string& name) const {
  const std::string made_by = std::string("anholon ") + ANHOLON_VERSION;
  if (data_->put_in.empty())
    return kind == Source::formulas ? data_->values().python_source() : data_->values().c_source(name, made_by);
  return data_->text_with_exponents([&](const inner::RateFormulas& f) {
    return kind == Source::formulas ? inner::emit_formulas(f) : inner::emit_casadi(f, name, made_by);
  });
}

std::vector<double> Dynamics::from_motion(double t, const std::vector<double>& q, const std::vector<double>& qdot,
                                          const std::vector<double>& z, std::span<const double> p) const {
  const Data* data = data_->at(p);
  return data ? data->function->from_motion(t, q, qdot, z, p) : std::vector<double>(states().size(), kNone);
}

Dynamics::Motion Dynamics::to_motion(double t, const std::vector<double>& x, std::span<const double> p) const {
  const Data* data = data_->at(p);
  auto [q, qdot, z] = (data ? data : data_.get())->function->to_motion(t, x, p);
  if (!data) std::fill(qdot.begin(), qdot.end(), kNone);
  return {std::move(q), std::move(qdot), std::move(z)};
}

}  // namespace anholon::v1
