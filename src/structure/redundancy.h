// Constraints that follow from others at a state: a choice of independent ones, and multipliers of least norm.
//
// If Phi = (dphi_r/dq^(m_r)) has rank r < s, q^(k) and N = Phi^T lambda are unique and lambda is not. The motion is
// computed with r independent constraints, and the residuals of the others are watched. Of all lambda with the same N,
// the one of least norm is reported (theory: dae-view, redundant constraints).
//
// A constraint that vanishes identically with the values of the parameters, such as s*(x' - y') = 0 with s = 0, says
// nothing: it is redundant, too, and its multiplier is 0.
#pragma once
#include <functional>

#include "structure/consistent.h"

namespace anholon {

struct IndependentConstraints {
  std::vector<std::size_t> independent;  // ascending
  std::vector<std::size_t> redundant;    // ascending; they follow from the independent ones at the state
  std::vector<std::size_t> vanishing;    // those of the redundant ones that vanish identically
  // the least sine of the angle between an independent row and the span of the rows chosen before it,
  double weakest = 1;
  std::size_t weakest_row = 0;  // and the index of that row
};

// Multiples of the rows of Phi, one for each row, whose sum is zero; 0 for a row that takes no part. If they are added to
// the multipliers, N stays as it is: the multipliers of the rows that take part are not determined one by one.
using Dependency = std::vector<double>;

// Chooses independent rows: constraints of lower order before those of higher order, which may be their derivatives,
// otherwise in the order of the file, and rows far from the span of others before nearer ones. A zero row of a
// constraint that does not vanish identically is a singularity of this constraint, not a redundancy: it counts as
// independent, and the system Jacobian shows the singularity. `vanishes`: tells whether a constraint vanishes
// identically; without it, none does.
IndependentConstraints choose_independent(const Matrix<double>& phi, const std::vector<int>& order,
                                          const std::function<bool(std::size_t)>& vanishes = {});

// True if constraint r is proved to vanish identically with these values of the parameters. The graph is not changed.
bool vanishes_identically(const Mechanics& m, const std::vector<double>& parameters, std::size_t r);

// Returns one dependency for each redundant row: its own, with the independent rows from which it follows; empty if it
// does not follow from them, at another state than that of the choice.
std::vector<Dependency> dependencies(const Matrix<double>& phi, const IndependentConstraints& choice);

// Returns the rows Phi of the constraints at a state; values that the state does not hold are arbitrary.
Matrix<double> constraint_rows(const Mechanics& m, const std::vector<double>& parameters,
                               const InitialState<double>& state);

// Chooses independent constraints at a state; values that the state does not hold (accelerations that are not yet
// found) are arbitrary.
IndependentConstraints independent_constraints(const Mechanics& m, const std::vector<double>& parameters,
                                               const InitialState<double>& state);

// Returns the lambda of least norm for all constraints, the rows of Phi, with the same N as `multipliers` of the
// independent ones. With Phi = C Phi_independent it is C (C^T C)^-1 multipliers.
template <Number N>
std::vector<N> least_multipliers(const Matrix<N>& phi, const std::vector<std::size_t>& independent,
                                 const std::vector<N>& multipliers);

}  // namespace anholon
