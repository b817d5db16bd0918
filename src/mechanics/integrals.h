// Functions whose differentials lie in a closed span of forms, where they are elementary (theory: integrability).
//
// Tried on each form, and on each of the span's reduced echelon forms: the form itself, and with an integrating factor
// mu(z_a) of one variable, mu'/mu = (dw_a/dz_b - dw_b/dz_a) / w_b. What is found first is put into the rest: one of its
// variables is solved for where f is linear in it, on the level f = c. So is a holonomic constraint.
#pragma once
#include "mechanics/pfaff.h"

namespace anholon {

// Independent functions f, each proved: X f = 0 for all X of `kernel`, the fields that the forms of all constraints
// annul. `forms`: a basis of a span closed under d, in which the differentials of `holonomic` lie. `own`: more forms of
// that span, which are tried first.
std::vector<Expr> first_integrals(const FormSpace& space, Rows forms, Rows own, const Column& holonomic,
                                  const Rows& kernel, FormPoint& at);

// A multiple of the integral by a constant, without constant denominators and common factors, as a person would write
// it.
Expr readable(const FormSpace& space, Expr f, const SymbolNames& names);

// dw = 0 modulo the forms, for each of them: dw(X, Y) = 0 on the fields that they all annul, w(X) = 0; proved.
bool proved_closed(const FormSpace& space, const Rows& forms, const Rows& kernel, const Rows& brackets);

}  // namespace anholon
