// Multipliers that the equations do not determine one by one, because their constraints depend on one another and share
// a force (theory: dae-view, redundant constraints).
//
//   If Phi^T v = 0, then lambda and lambda + c v give the same N = Phi^T lambda, for every c.
//
// A multiplier is determined if no such v has an entry for it. A formula is determined if it does not change along v: the
// sum 2 lambda_1 + lambda_2 of two constraints with Phi_1 = 2 Phi_2 is.
#pragma once
#include <vector>

#include "structure/redundancy.h"

namespace anholon {

// True if a constraint takes part in a dependency.
inline bool takes_part(const Dependency& d, std::size_t r) { return r < d.size() && d[r] != 0; }

struct UndeterminedMultipliers {
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

UndeterminedMultipliers undetermined_multipliers(const Mechanics& m, const std::vector<double>& parameters,
                                                 const InitialState<double>& state,
                                                 const IndependentConstraints& choice);

}  // namespace anholon
