// The unit in which users give and see the number of a parameter: the one that the file declares for it, as in
// m = {value = 500, unit = "g"}. Formulas, generated programs and `Dynamics` have the same quantity in SI units.
#pragma once
#include <string>
#include <vector>

#include "model/model.h"

namespace anholon {

struct DeclaredUnit {
  Rational size = 1;  // in SI units; to 60 digits if it contains pi
  // Empty if numbers in this unit are those in SI units.
  std::string name = {};

  // Returns the number of a quantity of which `value` is that in SI units. Where the size is not exact, it is rounded to
  // the digits that are certain, so that 30 deg are 30.
  Rational number(const Rational& value) const;
  Rational in_si(const Rational& number) const { return name.empty() ? number : Rational(number * size); }
};

DeclaredUnit declared_unit(const Parameter& parameter);
// Returns the unit in which a user sees the number of a parameter, "g", or the SI unit; empty if it is unknown.
std::string unit_of_parameter(const Model& model, std::size_t index);
// Returns the numbers of the parameters as users see them, each rounded once. REQUIRES: all parameters have values.
std::vector<double> parameters_as_given(const Model& model);

}  // namespace anholon
