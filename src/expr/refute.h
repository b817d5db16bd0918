// Refutes "zero" by a value in a prime field; the exact zero test (normal.h) is then unnecessary.
//
// The rules of the normal form, sin^2 + cos^2 = 1 with the addition theorems and root^k = radicand, hold at a random
// point of the field: points of the circle for angles, roots of values, anything for other functions. An expression
// that is zero by these rules has the value 0 wherever it has a value, so another value is a proof that the normal form
// does not show it to be zero. It takes a fraction of a microsecond per node.
#pragma once
#include "expr/expr.h"

namespace anholon {

// True proves that the normal form does not show e to be zero; false proves nothing.
bool refuted(Expr e);

}  // namespace anholon
