// A published equation, read in the names of a model.
#pragma once
#include <string>

#include "formula/formula.h"

namespace anholon {

struct PublishedEquation {
  std::string label;
  Span span;           // place of the label
  FormulaText source;  // both sides, with the place of each character
  Syntax left, right;

  std::string text() const { return print(left) + " = " + print(right); }
};

}  // namespace anholon
