#include "anholon/dynamics.h"

#include <mutex>

#include "api/data.h"
#include "dynamics/rate_formulas_of.h"
#include "setup/inputs.h"

namespace anholon::v1 {

struct Dynamics::Data {
  System system;
  inner::Scenario opened;               // with inputs as parameters, if there are inputs
  const inner::Scenario* scenario;      // of the system, or the opened one
  std::vector<std::string> inputs;      // names
  std::vector<inner::NodeId> formulas;  // of the inputs
  std::unique_ptr<const inner::Dynamics> function;
  std::vector<StateName> states;

  // The formulas, made when they are asked for first.
  const inner::FormulaValues& values() const {
    std::call_once(once_, [&] {
      inner::Workspace own(*scenario);
      values_ = std::make_unique<const inner::FormulaValues>(inner::rate_formulas_of(own, *function, formulas));
    });
    return *values_;
  }

  // A point of one state: its parameters, and what the equations are solved for.
  struct Solved {
    std::vector<double> parameters, lead;
    inner::FormulaValues::Point at;
  };
  Solved solved(double t, const std::vector<double>& x, const Given& given, bool with_lead) const {
    Solved out;
    const std::vector<double> u = given_inputs(t, x, given);
    const inner::InputsAndParameters numbers{u, given.p};
    for (const long double p : function->parameters(numbers, 1, 0)) out.parameters.push_back(static_cast<double>(p));
    if (with_lead && !function->minimal()) out.lead = function->leading(t, x, numbers);
    out.at = {t, x, out.parameters, out.lead};
    return out;
  }
  // u, by the formulas of the model where none is given.
  std::vector<double> given_inputs(double t, const std::vector<double>& x, const Given& given) const {
    if (!given.u.empty() || inputs.empty()) return {given.u.begin(), given.u.end()};
    std::vector<double> parameters;
    for (const long double p : function->parameters({{}, given.p}, 1, 0)) parameters.push_back(static_cast<double>(p));
    return values().inputs({t, x, parameters, {}});
  }

 private:
  mutable std::once_flag once_;
  mutable std::unique_ptr<const inner::FormulaValues> values_;

 public:
  explicit Data(System of) : system(std::move(of)), scenario(&system.data().scenario) {}
};

Result<Dynamics> dynamics(const System& system, const DynamicsOptions& options) {
  const System::Data& of = system.data();
  return guarded(of.model->source, [&]() -> Result<Dynamics> {
    auto data = std::make_shared<Dynamics::Data>(system);
    if (options.inputs || !options.input_names.empty()) {
      const inner::InputsAsParameters inputs = inner::inputs_as_parameters(of.scenario, options.input_names);
      data->inputs = inputs.names, data->formulas = inputs.formulas;
      if (const inner::Outcome o = make_system(inputs.model, of.scenario.system.form->name, of.choice, data->opened);
          !o.ok())
        return error_of(o);
      data->scenario = &data->opened;
    }
    inner::Workspace s(*data->scenario);
    std::string why;
    data->function = inner::Dynamics::make(s, of.choice, {options.minimal, data->inputs.size()}, why);
    if (!data->function)
      return mistake("there is no function x' = f(t, x) of these equations: " + why,
                     "simulate integrates them all the same");
    for (const inner::Dynamics::State& state : data->function->states())
      data->states.push_back({state.name, state.meaning});
    return Dynamics(data);
  });
}

const std::vector<StateName>& Dynamics::states() const { return data_->states; }
std::vector<std::string> Dynamics::inputs() const { return data_->inputs; }
std::vector<std::string> Dynamics::outputs() const { return data_->values().formulas().output_names; }
bool Dynamics::minimal() const { return data_->function->minimal(); }
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
  inner::InputsAndParameters numbers{given.u, given.p};
  std::vector<double> u;
  if (given.u.empty() && !data_->inputs.empty() && count > 0) {
    // By the formulas of the model, state by state.
    const std::size_t inputs = data_->inputs.size(), parameters = data_->function->free_parameters().size();
    u.resize(inputs * count);
    std::vector<double> state(data_->states.size()), p(given.p.empty() ? 0 : parameters);
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t i = 0; i < state.size(); ++i) state[i] = x[i * count + k];
      for (std::size_t i = 0; i < p.size(); ++i) p[i] = given.p[given.p.size() == parameters ? i : i * count + k];
      const std::vector<double> of_state = data_->given_inputs(t, state, {{}, p});
      for (std::size_t i = 0; i < inputs; ++i) u[i * count + k] = of_state[i];
    }
    numbers.u = u;
  }
  data_->function->rates(t, x.data(), count, rates.data(), numbers);
}

std::vector<double> Dynamics::inputs(double t, const std::vector<double>& x, std::span<const double> p) const {
  return data_->given_inputs(t, x, {{}, p});
}

std::vector<double> Dynamics::outputs(double t, const std::vector<double>& x, const Given& given) const {
  return data_->values().outputs(data_->solved(t, x, given, true).at);
}

Dynamics::Jacobian Dynamics::jacobian(double t, const std::vector<double>& x, const Given& given) const {
  auto [rows, columns, values] = data_->values().derivatives(data_->solved(t, x, given, true).at);
  return {rows, columns, std::move(values)};
}

Dynamics::Equations Dynamics::equations(double t, const std::vector<double>& x, const Given& given) const {
  auto [matrix, right] = data_->values().equations(data_->solved(t, x, given, false).at);
  return {data_->values().formulas().lead.names, std::move(matrix), std::move(right)};
}

std::string Dynamics::source(Source kind, const std::string& name) const {
  const inner::RateFormulas& f = data_->values().formulas();
  return kind == Source::formulas ? inner::emit_formulas(f)
                                  : inner::emit_casadi(f, name, std::string("anholon ") + ANHOLON_VERSION);
}

std::vector<double> Dynamics::from_motion(double t, const std::vector<double>& q, const std::vector<double>& qdot,
                                          const std::vector<double>& z) const {
  return data_->function->from_motion(t, q, qdot, z);
}

Dynamics::Motion Dynamics::to_motion(double t, const std::vector<double>& x) const {
  auto [q, qdot, z] = data_->function->to_motion(t, x);
  return {std::move(q), std::move(qdot), std::move(z)};
}

}  // namespace anholon::v1
