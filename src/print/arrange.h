// Expressions as a person would write them: common factors in front, equal coefficients gathered, accelerations first,
//   (J + a^2*M + b^2*m)*theta'' + (a*M + b*m)*(y''*cos(theta) - x''*sin(theta)).
//
// Each arrangement is an identity: the normal form (normal.h), sin^2 + cos^2 = 1 and the addition theorems applied
// backwards, factors found by FLINT, and the distributive law.
#pragma once
#include "expr/normal.h"
#include "print/print.h"

namespace anholon {

// Returns the shortest in print of e itself, `expanded(e)` and several arrangements; equal to e wherever e is defined.
// Names in `names.defined` are kept if e contains them. Large expressions get less effort.
Expr arranged(Expr e, const SymbolNames& names);

// written_out() and arranged() together serve callers that also need `expanded(e)`: it is the expression of the
// returned form, if both exist.
std::optional<NormalForm> written_out(Expr e);
Expr arranged(Expr e, const SymbolNames& names, const std::optional<NormalForm>& plain);

}  // namespace anholon
