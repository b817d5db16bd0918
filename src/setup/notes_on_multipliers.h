// Notes on multipliers that the equations do not determine one by one, and on formulas that contain them.
#pragma once
#include <string>
#include <vector>

#include "setup/undetermined_multipliers.h"

namespace anholon {

// A formula with the words that name it, such as "monitor 'load'".
struct NamedFormula {
  std::string what;
  Expr formula;
};
// Returns the monitors, outputs, rates, conditions, events and what they set, as far as they hold multipliers.
std::vector<NamedFormula> formulas_with_multipliers(const Model& model);

// Returns a note on a group: what is determined, what the columns have, and what to do. `least`: the columns have the
// multipliers of least norm, otherwise zeros for constraints that are left out.
std::string note_of_undetermined(const Model& model, const UndeterminedMultipliers& shared,
                                 const std::vector<std::size_t>& group, bool least);
// Returns a note on a formula whose value is not determined, because it holds such a multiplier; empty if it is.
std::string note_of_formula(const Model& model, const UndeterminedMultipliers& shared,
                            const InitialState<double>& state, const NamedFormula& formula);

// Returns names as a list, with 'and' before the last one.
std::string joined_names(const std::vector<std::string>& names);
// Returns the names of these multipliers as a list.
std::string multiplier_names(const Model& model, const std::vector<std::size_t>& constraints);
// Returns what makes constraints no longer hold a direction: `along = ["ex", "ey"] in 'roll'` for the component roll.z of
// a vector equation, `'twice' left out` for another constraint. `example`: the directions are named.
std::string without_constraints(const Model& model, const std::vector<std::size_t>& constraints, bool example);

}  // namespace anholon
