// Multipliers that the equations do not determine one by one, because their constraints depend on one another and share
// a force; and what is said of them (theory: dae-view, redundant constraints).
//
//   If Phi^T v = 0, then lambda and lambda + c v give the same N = Phi^T lambda, for every c.
//
// A multiplier is determined if no such v has an entry for it. A formula is determined if it does not change along v: the
// sum 2 lambda_1 + lambda_2 of two constraints with Phi_1 = 2 Phi_2 is.
#pragma once
#include <string>
#include <vector>

#include "structure/redundancy.h"

namespace anholon {

struct SharedForces {
  std::vector<std::size_t> redundant;    // the constraints that are left out
  std::vector<Dependency> dependencies;  // of each of them, at the initial state
  // True for a redundant constraint that follows from the same constraints at other places as well.
  std::vector<bool> lasts;

  bool any() const { return !dependencies.empty(); }
  // Returns the constraints whose multipliers are not determined, those with a common force together; ascending.
  std::vector<std::vector<std::size_t>> groups() const;
  // The group of a constraint; empty if its multiplier is determined.
  std::vector<std::size_t> group_of(std::size_t constraint) const;
  // True if the multiplier is determined at the initial state, and at other places as far as the constraints tell.
  bool determined_everywhere(std::size_t constraint) const;
};

SharedForces shared_forces(const Mechanics& m, const std::vector<double>& parameters, const InitialState<double>& state,
                           const IndependentConstraints& choice);

// A formula with the words that name it, such as "monitor 'load'".
struct NamedFormula {
  std::string what;
  Expr formula;
};
// Returns the monitors, outputs, rates, conditions, events and what they set, as far as they hold multipliers.
std::vector<NamedFormula> formulas_with_multipliers(const Model& model);

// Returns a note on a group: what is determined, what the columns have, and what to do. `least`: the columns have the
// multipliers of least norm, otherwise zeros for constraints that are left out.
std::string note_of_shared_force(const Model& model, const SharedForces& shared, const std::vector<std::size_t>& group,
                                 bool least);
// Returns a note on a formula whose value is not determined, because it holds such a multiplier; empty if it is.
std::string note_of_formula(const Model& model, const SharedForces& shared, const InitialState<double>& state,
                            const NamedFormula& formula);

// Returns names as a list, with 'and' before the last one.
std::string joined_names(const std::vector<std::string>& names);
// Returns the names of these multipliers as a list.
std::string multiplier_names(const Model& model, const std::vector<std::size_t>& constraints);
// Returns what makes constraints no longer hold a direction: `along = ["ex", "ey"] in 'roll'` for the component roll.z of
// a vector equation, `'twice' left out` for another constraint. `example`: the directions are named.
std::string without_constraints(const Model& model, const std::vector<std::size_t>& constraints, bool example);

}  // namespace anholon
