#include "modelfile/names/declared_unit.h"

#include "formula/units.h"
#include "modelfile/names/constant.h"
#include "numeric/number.h"

namespace anholon {

namespace {

constexpr int kCertainDigits = 50;  // of a quotient of two numbers with 60 digits

Rational rounded(const Rational& value) {
  const PrecisionScope precision(kCertainDigits + 10);
  return parse_rational(number_text(Multi(value), kCertainDigits)).value_or(value);
}

}  // namespace

Rational DeclaredUnit::number(const Rational& value) const {
  if (name.empty()) return value;
  const Rational quotient = value / size;
  const std::optional<Unit> unit = read_unit(name);
  return unit && unit->pi == 0 ? quotient : rounded(quotient);
}

DeclaredUnit declared_unit(const Parameter& p) {
  if (p.unit.empty()) return {};
  const Rational size = read_constant("1 " + p.unit).value;
  return size == 1 ? DeclaredUnit{} : DeclaredUnit{size, p.unit};
}

std::string unit_of_parameter(const Model& model, std::size_t index) {
  const DeclaredUnit unit = declared_unit(model.parameters[index]);
  if (!unit.name.empty()) return unit.name;
  return index < model.parameter_units.size() ? model.parameter_units[index] : std::string();
}

std::vector<double> parameters_as_given(const Model& model) {
  Column values;
  for (const Parameter& p : model.parameters) values.push_back(p.value);
  std::vector<double> numbers = evaluate_parameters<double>(*model.graph, values);
  const PrecisionScope precision(kCertainDigits + 10);
  std::vector<Multi> sharp;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const DeclaredUnit unit = declared_unit(model.parameters[i]);
    if (unit.name.empty()) continue;
    if (sharp.empty()) sharp = evaluate_parameters<Multi>(*model.graph, values);
    if (is_finite(sharp[i]))
      numbers[i] = from_rational<double>(unit.number(*parse_rational(number_text(sharp[i], kCertainDigits + 10))));
  }
  return numbers;
}

}  // namespace anholon
