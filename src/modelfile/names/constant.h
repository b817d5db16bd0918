// A constant on a command line: "0.25", "1/3", "pi/2", "8 cm", "30 deg".
#pragma once
#include <optional>
#include <string>

#include "formula/units.h"
#include "model/model.h"

namespace anholon {

struct Constant {
  Rational value;                      // in SI units; to 60 digits if it contains pi or a root
  std::optional<Dimension> dimension;  // the dimension of a number with a unit; nullopt for a bare number
};

// Reads a constant. Throws Failure with the position in the text, as a column of line 1.
Constant read_constant(const std::string& text);

// Returns the value of an expression of parameters and numbers; nullopt if it depends on anything else.
std::optional<double> constant_value(const Model& model, Expr e);

}  // namespace anholon
