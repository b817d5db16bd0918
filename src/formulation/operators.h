// The operators on the kinetic energy that several forms share, and the order m in which a form uses them.
#pragma once
#include "mechanics/elimination.h"

namespace anholon {

// The right side: the given and the inertial forces and the reactions sum lambda dphi/dq^(m)  [L 2.7]
Column right_side(const Mechanics& M);
// Returns the highest order of the constraints, at least 1. A constraint of lower order can be lifted to it without
// changing N.
unsigned highest_order(const Mechanics& M);
// Returns the order m of the forms with multipliers: the requested order, else the highest order of the constraints.
unsigned order_of(const Mechanics& M, const Elimination& E);
// T^(k) = D^k T/Dt^k
Expr T(const Mechanics& M, unsigned k);
// D/Dt dT/dq' - dT/dq, of Lagrange
Column lagrange_operator(const Mechanics& M);
// m D/Dt dT^(m-1)/dq^(m) - dT^(m-1)/dq^(m-1), of Nielsen  [L 3.10]
Column nielsen_operator(const Mechanics& M, unsigned m);
// dT^(m)/dq^(m) - dT^(m-1)/dq^(m-1) - dT/dq, of Micevic and Rusov  [N 3.1]
Column micevic_rusov_operator(const Mechanics& M, unsigned m);
// 1/m [dT^(m)/dq^(m) - (m+1) dT/dq]  [N 5.1], left side
Column mangeron_deleanu_operator(const Mechanics& M, unsigned m);

}  // namespace anholon
