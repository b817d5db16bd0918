// Expressions in few functions, among which the zero test (expr/normal.h) knows more relations.
#pragma once
#include "proof/prove.h"

namespace anholon {

// The absolute value is the root of a square, and u sign(u) is |u|. Exponentials of sums are products, and the hyperbolic
// functions are exponentials. Sines and cosines of multiples of pi/12 are numbers, and tan is sin/cos. Arguments and
// radicands are reduced, so that equal ones are one node, and radicands give up their even powers. Equal to e wherever both
// are defined.
Expr in_few_functions(Expr e);
// Also with logarithms of products as sums of logarithms of squares, which have values for negative factors, too.
Expr with_split_logarithms(Expr e);

// As shown_zero(), also by these relations, and by cases of the signs that decide in choices.
bool shown_zero_in_few_functions(Expr e, Effort effort);

}  // namespace anholon
