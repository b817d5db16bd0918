#include "api/data.h"

#include <algorithm>

#include "modelfile/names/constant.h"
#include "numeric/number.h"

namespace anholon::v1 {

namespace {

// The enumerations of the public headers list the same kinds in the same order.
static_assert(static_cast<int>(OutcomeKind::too_large) == static_cast<int>(inner::OutcomeKind::too_large));
static_assert(static_cast<int>(OutcomeKind::interrupted) == static_cast<int>(inner::OutcomeKind::interrupted));
static_assert(static_cast<int>(OutcomeKind::inconsistent) == static_cast<int>(inner::OutcomeKind::inconsistent));
static_assert(static_cast<int>(OutcomeKind::singular) == static_cast<int>(inner::OutcomeKind::singular));
static_assert(static_cast<int>(Severity::note) == static_cast<int>(inner::Severity::note));

std::string suggestion(const std::string& name, const std::vector<std::string>& names) {
  const std::string near = inner::did_you_mean(name, names);
  return near.empty() ? "" : "; did you mean '" + near + "'?";
}

std::string list_of_forms(const inner::Mechanics* m) {
  std::string list;
  for (const inner::Formulation* f : inner::formulations())
    if (!m || inner::obstacle(*f, *m).empty()) list += (list.empty() ? "" : ", ") + std::string(f->name);
  return list;
}

std::size_t place(const std::vector<std::string>& names, const std::string& name, const std::string& what) {
  const auto it = std::find(names.begin(), names.end(), name);
  if (it == names.end()) throw inner::Failure({}, "there is no " + what + " '" + name + "'" + suggestion(name, names));
  return static_cast<std::size_t>(it - names.begin());
}

}  // namespace

const char* name(OutcomeKind kind) { return inner::name(static_cast<inner::OutcomeKind>(kind)); }

Number::Number(double value) : text_(inner::number_text(value)) {}
Number::Number(int value) : text_(std::to_string(value)) {}

Severity to_public(inner::Severity severity) { return static_cast<Severity>(severity); }
OutcomeKind to_public(inner::OutcomeKind kind) { return static_cast<OutcomeKind>(kind); }
Outcome to_public(const inner::Outcome& o) { return {to_public(o.kind), o.message, o.hint}; }

Diagnostic to_public(const inner::Diagnostic& d, const inner::SourceText& source) {
  return {to_public(d.severity), d.message, d.hint, source.of(d.span).name, d.span.line, d.span.column, d.span.length};
}

Error error_of(const inner::Diagnostics& diagnostics, const inner::SourceText& source) {
  Error e;
  for (const inner::Diagnostic& d : diagnostics.list()) e.diagnostics.push_back(to_public(d, source));
  e.text = diagnostics.print(source);
  return e;
}

Error error_of(const inner::Failure& failure, const inner::SourceText& source) {
  const inner::Diagnostic& d = failure.diagnostic;
  if (d.span.line == 0) return mistake(d.message, d.hint);
  return {{to_public(d, source)}, {}, inner::print(d, source)};
}

Error error_of(const inner::Outcome& o) {
  return {{},
          to_public(o),
          std::string("stopped (") + inner::name(o.kind) + "): " + o.message + "\n" +
              (o.hint.empty() ? "" : "hint: " + o.hint + "\n")};
}

Error mistake(const std::string& message, const std::string& hint) {
  Diagnostic d;
  d.message = message;
  d.hint = hint;
  return {{d}, {}, "error: " + message + "\n" + (hint.empty() ? "" : "hint: " + hint + "\n")};
}

inner::Rational exact(const Number& number, const std::string& argument) {
  try {
    return inner::read_constant(number.text()).value;
  } catch (const inner::Failure&) {
    const std::string& text = number.text();
    throw inner::Failure({}, argument + ": '" + text + "' is not a number",
                         "a decimal such as 0.25, 1e-12, a fraction 1/3, pi/2 or a number with a unit, '30 deg'");
  }
}

const inner::Formulation& find_form(const std::string& name, const inner::Mechanics* mechanics) {
  const inner::Formulation* f = inner::find_formulation(name);
  if (!f) {
    std::vector<std::string> names;
    for (const inner::Formulation* k : inner::formulations()) names.emplace_back(k->name);
    throw inner::Failure({}, "there is no form '" + name + "'" + suggestion(name, names),
                         "the forms are " + list_of_forms(nullptr));
  }
  if (!mechanics) return *f;
  if (const std::string why = inner::obstacle(*f, *mechanics); !why.empty())
    throw inner::Failure({}, "the form '" + name + "' does not apply: " + why, "these do: " + list_of_forms(mechanics));
  return *f;
}

inner::StateChoice state_choice(const PrepareOptions& options, const inner::Model& model) {
  inner::StateChoice choice;
  for (const std::string& name : options.eliminate)
    choice.eliminate.push_back(place(model.names.coordinates, inner::normal_name(name), "coordinate"));
  unsigned highest = 2;  // derivatives of this order follow from the state
  for (const inner::Constraint& c : model.constraints) highest = std::max(highest, static_cast<unsigned>(c.order));
  for (const auto& [written, number] : options.initial) {
    if (written == "t") {
      choice.t = exact(number, "initial t");
      continue;
    }
    std::string name = written;
    unsigned order = 0;
    while (!name.empty() && name.back() == '\'') name.pop_back(), ++order;
    name = inner::normal_name(name);
    constexpr std::string_view kLambda = "lambda.";
    const bool multiplier = name.starts_with(kLambda);
    const std::size_t index = multiplier ? place(model.names.multipliers, name.substr(kLambda.size()), "constraint")
                                         : place(model.names.coordinates, name, "coordinate");
    if (order + (multiplier ? 2U : 0U) >= highest)
      throw inner::Failure({}, "initial " + written + " follows from the state",
                           multiplier ? "multipliers are initial data for constraints of order 3 and more"
                                      : "give derivatives below order " + std::to_string(highest));
    choice.overrides.push_back({order, index, exact(number, "initial " + written), multiplier});
  }
  return choice;
}

inner::Outcome make_system(std::shared_ptr<const inner::Model> model, const std::string& form,
                           const inner::StateChoice& choice, inner::Scenario& scenario) {
  const inner::Formulation& f = find_form(form);
  {
    const std::shared_ptr<const inner::Model> own = inner::clone(*model);
    const inner::Mechanics m = inner::mechanics(*own);
    find_form(form, &m);
  }
  if (f.unknowns == inner::Unknowns::variational)
    throw inner::Failure({}, "the form '" + form + "' is another mechanics: no motion is computed with it",
                         "derive and compare it, or name another form");
  if (const auto d = inner::not_integrated(*model)) throw inner::Failure(*d);
  return inner::make_scenario(std::move(model), f, choice, scenario);
}

}  // namespace anholon::v1
