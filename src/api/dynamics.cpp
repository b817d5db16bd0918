#include "anholon/dynamics.h"

#include <algorithm>
#include <limits>
#include <mutex>

#include "api/data.h"
#include "contact/mode/switched_model.h"
#include "dynamics/pieces.h"
#include "dynamics/rate_formulas_of.h"
#include "model/exponents.h"
#include "setup/chosen_outputs.h"
#include "setup/inputs.h"

namespace anholon::v1 {

constexpr std::size_t kStatesAtOnce = 64;  // states that one thread takes at once, for outputs and derivatives

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

struct Dynamics::Data {
  System system;
  inner::Scenario opened;               // a scenario with outputs of its own, or with inputs as parameters
  const inner::Scenario* scenario;      // that of the system, or the opened one
  std::vector<std::string> inputs;      // names
  std::vector<inner::NodeId> formulas;  // formulas of the inputs
  std::vector<inner::NodeId> open;      // the same, in terms of the parameters that are inputs
  std::unique_ptr<const inner::Dynamics> function;
  std::string obstacle;  // why there are no independent velocities
  std::vector<StateName> states;

  // Returns the formulas, which are made at the first call.
  const inner::FormulaValues& values() const {
    std::call_once(once_, [&] {
      inner::Workspace own(*scenario);
      values_ = std::make_unique<const inner::FormulaValues>(inner::rate_formulas_of(own, *function, formulas, open));
    });
    return *values_;
  }

  // The states of one call: number i of state k is at i * count + k.
  struct Batch {
    double t;
    std::span<const double> x;
    std::size_t count;
    const Dynamics::Given& given;
    // Returns the inputs or parameters of state k, of which there are `size`; if `all` holds no more than `size`
    // numbers, all states share them.
    std::vector<double> of_state(std::span<const double> all, std::size_t size, std::size_t k) const {
      if (all.size() <= size) return {all.begin(), all.end()};
      std::vector<double> some(size);
      for (std::size_t i = 0; i < size; ++i) some[i] = all[i * count + k];
      return some;
    }
  };

  // The points of some states, with their parameters and the leading derivatives.
  struct Points {
    std::vector<std::vector<double>> x, parameters;
    std::vector<double> lead;
    std::vector<inner::FormulaPoint> at;
  };
  // Returns the points of the states from..to of a batch.
  Points points(const Batch& batch, std::size_t from, std::size_t to, bool with_lead) const {
    const std::size_t n = states.size(), some = to - from;
    Points out;
    std::vector<double> x_of(n * some), u_of(inputs.size() * some), p_of(batch.given.p.empty() ? 0 : p_size() * some);
    for (std::size_t k = from; k < to; ++k) {
      std::vector<double> x(n);
      for (std::size_t i = 0; i < n; ++i) x_of[i * some + k - from] = x[i] = batch.x[i * batch.count + k];
      const std::vector<double> p = batch.of_state(batch.given.p, p_size(), k);
      const std::vector<double> u = given_inputs(batch.t, x, {batch.of_state(batch.given.u, inputs.size(), k), p});
      for (std::size_t i = 0; i < u.size(); ++i) u_of[i * some + k - from] = u[i];
      for (std::size_t i = 0; i < p.size(); ++i) p_of[i * some + k - from] = p[i];
      std::vector<double> all;
      for (const long double value : function->parameters({u, p}, 1, 0)) all.push_back(static_cast<double>(value));
      out.x.push_back(std::move(x)), out.parameters.push_back(std::move(all));
    }
    std::size_t unknowns = 0;
    if (with_lead && !function->minimal()) {
      const bool common = batch.given.u.size() == inputs.size() && batch.given.p.size() <= p_size();
      out.lead = function->leading(batch.t, x_of.data(), some,
                                   common ? inner::InputsAndParameters{batch.given.u, batch.given.p}
                                          : inner::InputsAndParameters{u_of, p_of});
      unknowns = out.lead.size() / some;
    }
    for (std::size_t k = 0; k < some; ++k)
      out.at.push_back({batch.t, out.x[k], out.parameters[k], std::span(out.lead).subspan(k * unknowns, unknowns)});
    return out;
  }
  // Returns the inputs u as given, or by the formulas of the model if none are given.
  std::vector<double> given_inputs(double t, const std::vector<double>& x, const Given& given) const {
    if (!given.u.empty() || inputs.empty()) return {given.u.begin(), given.u.end()};
    return values().inputs({t, x, parameters(given.p), {}});
  }
  std::size_t p_size() const { return function->free_parameters().size(); }
  // Returns the values of all parameters of the model.
  std::vector<double> parameters(std::span<const double> p) const {
    std::vector<double> all;
    for (const long double value : function->parameters({{}, p}, 1, 0)) all.push_back(static_cast<double>(value));
    return all;
  }

  void rates(double t, std::span<const double> x, std::size_t count, std::span<double> rates, const Given& given) const;

  // Calls f(first, points) with the points of pieces of a batch, on several threads if there are many. The numbers of a
  // state do not depend on the other states.
  template <class F>
  void in_points(const Batch& batch, bool with_lead, const F& f) const {
    values();
    inner::in_pieces(batch.count, kStatesAtOnce, [&](const inner::NextPiece& next) {
      while (const std::optional<std::size_t> from = next()) {
        const Points some = points(batch, *from, std::min(batch.count, *from + kStatesAtOnce), with_lead);
        f(*from, std::span<const inner::FormulaPoint>(some.at));
      }
    });
  }

 private:
  mutable std::once_flag once_;
  mutable std::unique_ptr<const inner::FormulaValues> values_;

 public:
  explicit Data(System of) : system(std::move(of)), scenario(&system.data().scenario) {}
};

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
    auto data = std::make_shared<Dynamics::Data>(system);
    const std::string form = of.scenario.system.form->name;
    inner::StateChoice choice = of.choice;
    choice.open_parameters.reset();  // the caller gives their values
    if (inner::any_exponents(*of.model->model)) {
      if (const inner::Outcome o = make_system(of.model->model, form, choice, data->opened); !o.ok())
        return error_of(o);
      data->scenario = &data->opened;
    }
    if (options.outputs) {
      inner::Diagnostics diagnostics;
      const auto open = of.model->open_again(diagnostics);
      if (!open) return error_of(diagnostics, of.model->source);
      std::vector<inner::ChosenOutput> outputs;
      for (const DynamicsOptions::Output& o : *options.outputs) outputs.push_back({o.name, o.formula});
      if (const inner::Outcome o = make_system(inner::with_outputs(*open, outputs), form, choice, data->opened);
          !o.ok())
        return error_of(o);
      data->scenario = &data->opened;
    }
    if (options.inputs || !options.input_names.empty()) {
      const inner::InputsAsParameters inputs = inner::inputs_as_parameters(*data->scenario, options.input_names);
      if (options.outputs && !inputs.left_out.empty())
        return mistake("the output '" + inputs.left_out[0] + "' holds the rate of an input, which is no argument",
                       "leave the output out, or the input among the arguments");
      data->inputs = inputs.names, data->formulas = inputs.formulas, data->open = inputs.open_formulas;
      inner::Scenario opened;
      if (const inner::Outcome o = make_system(inputs.model, form, choice, opened); !o.ok()) return error_of(o);
      data->opened = std::move(opened);
      data->scenario = &data->opened;
    }
    inner::Workspace s(*data->scenario);
    data->function =
        inner::Dynamics::make(s, choice,
                              {options.minimal, data->inputs.size(),
                               inner::switching_parameters(*data->scenario->model, of.model->contacts_of_file)},
                              data->obstacle);
    if (!data->function)
      return mistake("there is no function x' = f(t, x) of these equations: " + data->obstacle,
                     data->scenario->elimination.pivots().empty()
                         ? "another start may have one: give other initial values, in Python dynamics(initial={…})"
                         : "simulate integrates them all the same");
    for (const inner::Dynamics::State& state : data->function->states())
      data->states.push_back({state.name, state.meaning});
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
  or_stopped(rates, given, [&] { data_->rates(t, x, count, rates, given); });
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
  return data_->given_inputs(t, x, {{}, p});
}

std::vector<double> Dynamics::inputs(double t, const std::vector<double>& x, std::span<const double> p,
                                     std::span<const std::optional<double>> given) const {
  if (inputs().empty()) return {};
  return data_->values().inputs({t, x, data_->parameters(p), {}}, given);
}

std::vector<double> Dynamics::outputs(double t, std::span<const double> x, std::size_t count,
                                      const Given& given) const {
  std::vector<double> out(outputs().size() * count);
  or_stopped(out, given, [&] {
    data_->in_points({t, x, count, given}, true, [&](std::size_t first, std::span<const inner::FormulaPoint> points) {
      const std::vector<double> y = data_->values().outputs(points);
      const std::size_t size = y.size() / points.size();
      for (std::size_t k = 0; k < points.size(); ++k)
        for (std::size_t i = 0; i < size; ++i) out[i * count + first + k] = y[k * size + i];
    });
  });
  return out;
}

Dynamics::Jacobian Dynamics::jacobian(double t, std::span<const double> x, std::size_t count, const Given& given,
                                      By by) const {
  const inner::RateFormulas& f = data_->values().formulas();
  const std::size_t columns = by == By::state ? f.x.size() : by == By::input ? f.u.size() : f.p.size();
  Jacobian out{f.rates.size() + f.outputs.size(), columns, {}};
  out.values.resize(out.rows * out.columns * count);
  or_stopped(out.values, given, [&] {
    data_->in_points({t, x, count, given}, true, [&](std::size_t first, std::span<const inner::FormulaPoint> points) {
      const auto all = data_->values().derivatives(points, static_cast<inner::FormulaValues::By>(by));
      for (std::size_t k = 0; k < all.size(); ++k)
        for (std::size_t i = 0; i < all[k].values.size(); ++i) out.values[i * count + first + k] = all[k].values[i];
    });
  });
  return out;
}

Dynamics::Equations Dynamics::equations(double t, std::span<const double> x, std::size_t count,
                                        const Given& given) const {
  const std::vector<std::string>& unknowns = data_->values().formulas().lead.names;
  const std::size_t n = unknowns.size();
  Equations out{unknowns, std::vector<double>(n * n * count), std::vector<double>(n * count)};
  or_stopped(out.right, given, [&] {
    data_->in_points({t, x, count, given}, false, [&](std::size_t first, std::span<const inner::FormulaPoint> points) {
      const std::vector<double> values = data_->values().equations(points);
      for (std::size_t k = 0; k < points.size(); ++k) {
        const double* of_point = &values[k * n * (n + 1)];
        for (std::size_t i = 0; i < n * n; ++i) out.matrix[i * count + first + k] = of_point[i];
        for (std::size_t i = 0; i < n; ++i) out.right[i * count + first + k] = of_point[n * n + i];
      }
    });
  });
  return out;
}

bool Dynamics::linear() const { return data_->function->linear(); }

std::vector<double> Dynamics::leading(double t, const std::vector<double>& x, const Given& given) const {
  return data_->points({t, x, 1, given}, 0, 1, true).lead;
}

std::string Dynamics::source(Source kind, const std::string& name) const {
  const inner::FormulaValues& values = data_->values();
  return kind == Source::formulas ? values.python_source()
                                  : values.c_source(name, std::string("anholon ") + ANHOLON_VERSION);
}

std::vector<double> Dynamics::from_motion(double t, const std::vector<double>& q, const std::vector<double>& qdot,
                                          const std::vector<double>& z, std::span<const double> p) const {
  return data_->function->from_motion(t, q, qdot, z, p);
}

Dynamics::Motion Dynamics::to_motion(double t, const std::vector<double>& x, std::span<const double> p) const {
  auto [q, qdot, z] = data_->function->to_motion(t, x, p);
  return {std::move(q), std::move(qdot), std::move(z)};
}

}  // namespace anholon::v1
