// Constraints that follow from others at a state: a choice of independent ones, and multipliers of least norm.
//
// Where Phi = (dphi_r/dq^(m_r)) has rank r < s, q^(k) and N = Phi^T lambda are unique, lambda is not. The motion is
// computed with r independent constraints; the others are watched. Of all lambda with the same N the least one is
// reported (theory: dae-view, redundant constraints).
#pragma once
#include "structure/consistent.h"

namespace anholon {

struct IndependentConstraints {
  std::vector<std::size_t> independent;  // ascending
  std::vector<std::size_t> redundant;    // ascending; they follow from the independent ones at the state
  double weakest = 1;  // the least sine of the angle between an independent row and the span of those chosen before it,
  std::size_t weakest_row = 0;  // and whose it is
};

// The rows chosen: constraints of lower order before those of higher order, which may be their derivatives, and as the
// file lists them; rows that are nearly dependent only if there is no better one. A row that vanishes is a lost hold,
// not a redundancy: it counts as independent, and the system Jacobian will tell.
IndependentConstraints choose_independent(const Matrix<double>& phi, const std::vector<int>& order);

// The same at a state; what the state does not know (accelerations before they were found) has arbitrary values.
IndependentConstraints independent_constraints(const Mechanics& m, const std::vector<double>& parameters,
                                               const InitialState<double>& state);

// The least lambda of all constraints, the rows of Phi, with the same N as `multipliers` of the independent ones. With
// Phi = C Phi_independent it is C (C^T C)^-1 multipliers.
template <Number N>
std::vector<N> least_multipliers(const Matrix<N>& phi, const std::vector<std::size_t>& independent,
                                 const std::vector<N>& multipliers);

}  // namespace anholon
