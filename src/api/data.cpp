#include "api/data.h"

#include <algorithm>

#include "modelfile/names/constant.h"
#include "numeric/number.h"
#include "setup/choice.h"

namespace anholon::v1 {

namespace {

// The enumerations of the public headers list the same kinds in the same order.
static_assert(static_cast<int>(OutcomeKind::too_large) == static_cast<int>(inner::OutcomeKind::too_large));
static_assert(static_cast<int>(OutcomeKind::interrupted) == static_cast<int>(inner::OutcomeKind::interrupted));
static_assert(static_cast<int>(OutcomeKind::inconsistent) == static_cast<int>(inner::OutcomeKind::inconsistent));
static_assert(static_cast<int>(OutcomeKind::singular) == static_cast<int>(inner::OutcomeKind::singular));
static_assert(static_cast<int>(Severity::note) == static_cast<int>(inner::Severity::note));

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

inner::Rational option_value(const Number& number, const inner::MotionOption& option) {
  const inner::Constant value = constant(number, option.name);
  const std::string called = std::string(option.name) + ": ";
  return option.part == inner::MotionOption::Part::times ? inner::time_value(value, called)
                                                         : inner::pure_value(value, called);
}

inner::Constant constant(const Number& number, const std::string& argument) {
  try {
    return inner::read_constant(number.text());
  } catch (const inner::Failure&) {
    const std::string& text = number.text();
    throw inner::Failure({}, argument + ": '" + text + "' is not a number",
                         "a decimal such as 0.25, 1e-12, a fraction 1/3, pi/2 or a number with a unit, '30 deg'");
  }
}

const inner::Formulation& find_form(const std::string& name, const inner::Mechanics* mechanics) {
  const inner::Formulation& f = inner::named_form(name);
  if (mechanics) inner::must_apply(f, *mechanics);
  return f;
}

inner::StateChoice state_choice(const PrepareOptions& options, const inner::Model& model) {
  inner::StateChoice choice;
  for (const std::string& name : options.eliminate) choice.eliminate.push_back(inner::coordinate_of(model, name));
  for (const auto& [name, number] : options.initial) {
    const inner::Constant value = constant(number, "initial " + name);
    if (name == "t")
      choice.t = inner::time_value(value, "initial t: ");
    else
      inner::give(choice, model, inner::initial_name(name), value, "initial " + name + ": ");
  }
  return choice;
}

inner::Outcome make_system(std::shared_ptr<const inner::Model> model, const std::string& form,
                           const inner::StateChoice& choice, inner::Scenario& scenario) {
  const inner::Formulation& f = inner::named_form(form);
  {
    const std::shared_ptr<const inner::Model> own = inner::clone(*model);
    const inner::Mechanics m = inner::mechanics(*own);
    inner::must_apply(f, m);
    inner::must_have_motions(f, m);
  }
  if (const auto d = inner::not_integrated(*model)) throw inner::Failure(*d);
  return inner::make_scenario(std::move(model), f, choice, scenario);
}

}  // namespace anholon::v1
