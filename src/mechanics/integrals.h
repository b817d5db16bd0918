// Functions whose differentials lie in a closed span of forms, if they are elementary (theory: integrability).
//
// The search tries each form, and each of the span's reduced echelon forms: the form itself, and the form with an
// integrating factor mu(z_a) of one variable, mu'/mu = (dw_a/dz_b - dw_b/dz_a) / w_b. Each integral f is substituted in
// the remaining forms: on the level f = c it is solved for a variable in which it is linear. A holonomic constraint is
// treated alike.
#pragma once
#include "mechanics/pfaff.h"

namespace anholon {

// Returns independent functions f, each proved: X f = 0 for all X of `kernel`, the fields that the forms of all
// constraints annul. `forms`: a basis of a span closed under d, which contains the differentials of `holonomic`. `own`:
// further forms of that span, which are tried first.
std::vector<Expr> first_integrals(const FormSpace& space, Rows forms, Rows own, const Column& holonomic,
                                  const Rows& kernel, FormPoint& at);

// Returns a constant multiple of the integral, without constant denominators and common factors, for a reader.
Expr readable(const FormSpace& space, Expr f, const SymbolNames& names);

// Proves dw = 0 modulo the forms, for each of them: dw(X, Y) = 0 on the fields with w(X) = 0 for all forms.
bool proved_closed(const FormSpace& space, const Rows& forms, const Rows& kernel, const Rows& brackets);

}  // namespace anholon
