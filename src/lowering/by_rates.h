// Routh's equations [L 2.7] with total derivatives left to the Taylor series: the same equations, in far fewer
// operations.
//
// Derived equations contain the expanded formulas of d/dt; these contain the expressions whose series is
// differentiated. With r_c the components of mass centres that depend on q, V_c = D r_c, and T = T(q, q', V, t), the
// operator of Lagrange is
//
//   D dT/dq'_a - dT/dq_a = (the same of T with V held) + sum_c D(dT/dV_c) dr_c/dq_a,
//
// because dV_c/dq'_a = dr_c/dq_a and D dr_c/dq_a = dV_c/dq_a. For a chain this needs D^2 r_c and the product with
// dr_c/dq_a: four products a link. Reactions sum lambda dphi/dq' come from one reverse sweep in the same way, V held,
// then through r_c, so that common parts of links are computed once.
#pragma once
#include "system/system.h"

namespace anholon {

// The equations by rates, in a model that has only names and a graph of its own, to which `others` are copied. The
// unknowns and the order of the equations are those of `derived`. by_rates returns nullopt if the system is not
// Routh's, or if there is nothing to gain.
struct ByRates {
  System system;
  Column others;
};
std::optional<ByRates> by_rates(const System& derived, const Mechanics& mechanics, std::span<const Expr> others);

}  // namespace anholon
