// Which given values and which equations of a stage cannot hold together: a set that is consistent as soon as any one
// of its members is left out.
//
// Linear equations A x = b with given x_j = v_j: let the rows A_i, restricted to the free unknowns, have the basis I. A
// further row r is A_r = sum_I c_i A_i there, with unique c_i. Where rho = b_r - sum c_i b_i - sum_j (A_rj - sum c_i
// A_ij) v_j is not 0, the row, the A_i with c_i != 0 and the given values whose coefficient is not 0 are such a set,
// since no part of it is linearly dependent (a circuit of the matroid of rows). Of several the smallest is taken.
//
// Nonlinear equations: members are left out one by one as long as no solution is found (deletion filter; J. W. Chinneck
// and E. W. Dravnieks, ORSA Journal on Computing 3, 1991, 157-168). "No solution" is then what Newton's method from
// many starts says.
#pragma once
#include <optional>

#include "structure/stage.h"

namespace anholon {

template <Number N>
struct Contradiction {
  std::vector<std::size_t> equations, given;  // rows and unknowns of the stage, ascending
  std::optional<N> wanted;                    // where one value is given: what the equations ask for in its place
};

// `state` holds the given values and, for the free unknowns, the guess; it is left as it was. `worst` is an equation
// that was missed. Nothing is returned where no set is found, or where the search is out of proportion.
template <Number N>
std::optional<Contradiction<N>> contradiction(Stage<N>& stage, InitialState<N>& state, const std::vector<bool>& given,
                                              std::size_t worst);

}  // namespace anholon
