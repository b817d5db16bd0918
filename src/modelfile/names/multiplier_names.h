// Formulas in the names of a model file, with the multipliers of a given model.
#pragma once
#include <string>
#include <vector>

#include "formula/formula.h"

namespace anholon {

// Returns the value of a formula in which lambda.NAME is a multiplier, and `lambda` the only one. The multipliers may be
// those of a model in one mode of its contacts, which the file does not declare. Throws Failure.
Value evaluate_with_multipliers(const FormulaText& formula, Names& names, const std::vector<std::string>& multipliers);

// True if a multiplier occurs in the formula.
bool holds_multiplier(Expr formula);

}  // namespace anholon
