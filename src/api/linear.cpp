#include "anholon/linear.h"

#include "api/data.h"
#include "linear/study.h"
#include "model/motion_settings.h"
#include "setup/choice.h"

namespace anholon::v1 {

static_assert(static_cast<int>(Steadiness::unchecked) == static_cast<int>(inner::LinearModel::Motion::unchecked));

namespace {

constexpr int kDoubleDigits = 16;

using Complexes = std::vector<std::complex<double>>;

std::complex<double> in_double(const inner::Complex& z) { return {inner::to_double(z.re), inner::to_double(z.im)}; }

// Returns the number with `digits` digits if a double has fewer; else the text of the nearest double.
std::string text_of(const inner::Multi& x, int digits) {
  return digits > kDoubleDigits ? inner::number_text(x, digits) : inner::number_text(inner::to_double(x));
}

Matrix matrix_of(const inner::Matrix<inner::Multi>& a, int digits) {
  Matrix m{a.rows, a.cols, {}, {}};
  for (std::size_t r = 0; r < a.rows; ++r)
    for (std::size_t c = 0; c < a.cols; ++c) {
      m.values.push_back(inner::to_double(a(r, c)));
      if (digits > kDoubleDigits) m.texts.push_back(text_of(a(r, c), digits));
    }
  return m;
}

LinearModel model_of(const inner::LinearModel& from, int digits) {
  LinearModel m;
  m.motion = static_cast<Steadiness>(from.motion);
  m.why = from.why;
  std::string steady_without;
  for (const std::string& name : from.eliminate) steady_without += (steady_without.empty() ? "" : ", ") + name;
  if (!from.eliminate.empty()) m.why += "; the motion is steady if " + steady_without + " are eliminated";
  m.t = inner::to_double(from.t);
  m.states = from.states, m.dependent = from.dependent, m.inputs = from.inputs, m.outputs = from.outputs;
  m.notes = from.notes;
  for (const std::size_t i : from.cyclic) m.cyclic.push_back(from.states[i]);
  for (const std::size_t i : from.core) m.core.push_back(from.states[i]);
  for (const inner::Multi& x : from.values) {
    m.values.push_back(inner::to_double(x));
    if (digits > kDoubleDigits) m.value_texts.push_back(text_of(x, digits));
  }
  m.A = matrix_of(from.A, digits), m.B = matrix_of(from.B, digits);
  m.C = matrix_of(from.C, digits), m.D = matrix_of(from.D, digits);
  for (const inner::Eigenvalue& e : from.spectrum) {
    m.eigenvalues.push_back(in_double(e.value));
    if (digits > kDoubleDigits)
      m.eigenvalue_texts.push_back({text_of(e.value.re, digits), text_of(e.value.im, digits)});
    m.multiplicities.push_back(static_cast<int>(e.multiplicity));
    Complexes& mode = m.modes.emplace_back();
    for (const inner::Complex& z : e.vector) mode.push_back(in_double(z));
  }
  return m;
}

inner::LinearRequest request_of(const Model& model, const LinearOptions& options) {
  inner::MotionSettings checked;
  inner::set(checked, inner::motion_option("digits"), inner::Rational(options.digits), "digits");
  model.data().without_contacts("linearize");
  PrepareOptions state;
  state.initial = options.initial, state.eliminate = options.eliminate;
  inner::LinearRequest request;
  request.form = &inner::named_form(options.form);
  const std::shared_ptr<const inner::Model> own = model.data().own_copy();  // its graph holds the mechanics
  const inner::Mechanics m = inner::mechanics(*own);
  inner::must_apply(*request.form, m);
  inner::must_have_motions(*request.form, m);
  request.equilibrium = options.equilibrium;
  request.choice = state_choice(state, *model.data().model);
  request.digits = options.digits;
  return request;
}

// REQUIRES: as LinearStudy::compute().
inner::Linearization linearization(const inner::LinearStudy& study, const Model::Data& of,
                                   const inner::LinearRequest& request) {
  inner::Linearization l = study.compute();
  for (inner::LinearResult& r : l.results) of.hint_at_state(r.outcome, request.choice);
  return l;
}

Result<LinearModel> linear_model(const Model::Data& of, const inner::LinearRequest& request) {
  const inner::LinearStudy study(of.own_copy(), request);
  const inner::PrecisionScope precision(study.working_digits());
  const inner::Linearization l = linearization(study, of, request);
  const inner::LinearResult& r = l.results.at(0);
  if (!r.outcome.ok()) return error_of(r.outcome);
  return model_of(r.model, request.digits);
}

}  // namespace

Result<LinearModel> linearize(const Model& model, const LinearOptions& options) {
  return guarded(model.data().source, [&] { return linear_model(model.data(), request_of(model, options)); });
}

Result<LinearModel> linearize(const System& system) {
  const System::Data& of = system.data();
  return guarded(of.model->source, [&] {
    of.model->without_contacts("linearize");
    inner::LinearRequest request;
    request.form = of.scenario.system.form;
    request.choice = of.choice;
    return linear_model(*of.model, request);
  });
}

Result<Stability> stability(const Model& model, const std::string& parameter, const std::vector<Number>& values,
                            const LinearOptions& options) {
  return guarded(model.data().source, [&]() -> Result<Stability> {
    inner::LinearRequest request = request_of(model, options);
    inner::ParameterRange range{inner::parameter_of(*model.data().model, parameter), {}};
    range.unit = inner::declared_unit(model.data().model->parameters[range.parameter]);
    inner::GivenQuantity of = inner::GivenQuantity::of_parameter(*model.data().model, range.parameter);
    for (const Number& v : values) {
      const inner::Constant value = constant(v, parameter);
      if (const auto wrong = of.misfit(value))
        throw inner::Failure({}, parameter + ": " + wrong->message, wrong->hint("a number "));
      range.values.push_back(of.number(value));
    }
    if (values.empty()) return mistake("no value of '" + parameter + "' is given");
    request.range = std::move(range);
    const inner::LinearStudy study(model.data().own_copy(), request);
    const inner::PrecisionScope precision(study.working_digits());
    const inner::Linearization l = linearization(study, model.data(), request);
    Stability out;
    out.parameter = parameter;
    for (std::size_t k = 0; k < l.results.size(); ++k) {
      const inner::LinearResult& r = l.results[k];
      out.values.push_back(inner::to_double(inner::Multi(request.range->values[k])));
      out.outcomes.push_back(to_public(r.outcome));
      out.models.push_back(r.outcome.ok() ? model_of(r.model, request.digits) : LinearModel{});
    }
    out.curves = inner::curves(l);
    for (const inner::Crossing& c : l.crossings)
      out.crossings.push_back({inner::to_double(c.value), inner::to_double(c.frequency), c.eigenvalues, c.destabilizes,
                               text_of(c.value, request.digits), text_of(c.frequency, request.digits),
                               inner::meaning(c)});
    out.notes = l.notes;
    return out;
  });
}

}  // namespace anholon::v1
