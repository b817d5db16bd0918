// Expressions rewritten in few functions, among which the zero test (expr/normal.h) knows more relations.
#pragma once
#include "proof/prove.h"

namespace anholon {

// Rewrites e: absolute values are roots of squares, and u sign(u) is |u|; exponentials of sums are products, and
// hyperbolic functions are exponentials; sines and cosines of multiples of pi/12 are numbers, and tan is sin/cos.
// Arguments and radicands are reduced, so that equal ones are one node, and even powers are taken out of radicands. The
// result equals e wherever both are defined.
Expr in_few_functions(Expr e);
// Rewrites also logarithms of products as sums of logarithms of squares, which have values for negative factors as
// well.
Expr with_split_logarithms(Expr e);

// True if shown_zero() holds, also by these relations and by cases of the signs that decide in choices.
bool shown_zero_in_few_functions(Expr e, Effort effort);

}  // namespace anholon
