// Finds given values and equations of a stage that contradict each other: a minimal set, which is consistent if any one
// of its members is left out.
//
// Linear equations A x = b with given x_j = v_j: let the rows A_i, restricted to the free unknowns, have the basis I. A
// further row r is A_r = sum_I c_i A_i there, with unique c_i. If rho = b_r - sum c_i b_i - sum_j (A_rj - sum c_i A_ij)
// v_j is not 0, the row, the A_i with c_i != 0 and the given values whose coefficient is not 0 are such a set, since no
// proper subset is linearly dependent (a circuit of the matroid of rows). The smallest of several sets is taken.
//
// `contradictions` returns all sets of this kind.
//
// Nonlinear equations: members are left out one by one as long as no solution is found (deletion filter; J. W. Chinneck
// and E. W. Dravnieks, ORSA Journal on Computing 3, 1991, 157-168). "No solution" means that Newton's method from many
// starts finds none.
#pragma once
#include <optional>

#include "structure/stage.h"

namespace anholon {

template <Number N>
struct Contradiction {
  std::vector<std::size_t> equations, given;  // rows and unknowns of the stage, ascending
  // if exactly one value is given: the value that the equations require instead
  std::optional<N> wanted;
};

// Returns a minimal contradiction. `state` holds the given values and, for the free unknowns, the guess; the state is
// not changed. `worst` is an equation that does not hold. Returns nullopt if no set is found, or if the search would
// take too long.
template <Number N>
std::optional<Contradiction<N>> contradiction(Stage<N>& stage, InitialState<N>& state, const std::vector<bool>& given,
                                              std::size_t worst);

// A contradiction of a set of equations that are coupled through free unknowns.
template <Number N>
struct PartialContradiction {
  Contradiction<N> of;
  // false if the search would take too long; `of` then holds all equations and given values of the set
  bool minimal = true;
};

// Returns contradictions of all sets of coupled equations that have one; of linear equations, those of all rows beyond a
// basis. `fails[i]`: equation i does not hold where the attempt to solve the equations has ended.
template <Number N>
std::vector<PartialContradiction<N>> contradictions(Stage<N>& stage, InitialState<N>& state,
                                                    const std::vector<bool>& given, const std::vector<bool>& fails);

}  // namespace anholon
