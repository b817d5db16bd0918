// Partial derivatives whose values at single points are asked for.
//
// The drag |v| v has the derivative 0 at v = 0, but the rules of differentiation make it |v| + v v / |v|, which is 0/0
// there. Let u be a sum of squares, w = u^r with 0 < r < 1 and f = f(x, w). If u = 0 at a point, w is of the order
// |d|^2r at a distance d. For r >= 1/2, and for any r if f is linear in w, f has the derivatives df/dx with w held, if
// df/dw = 0 at the point. For r = 1/2 and df/dw != 0 it has a kink there, as |v| has.
//
// These expressions hold branches by u or by df/dw. They must be neither differentiated nor expanded in a series: the
// branch 0 holds at the point alone.
#pragma once
#include <span>

#include "expr/diff.h"

namespace anholon {

// The derivative of f where u = 0 and df/dw is not 0.
enum class AtKinks : std::uint8_t {
  no_value,  // not a number: 0/0, or a number divided by 0
  between,   // that with w held: a number between the one-sided derivatives in a direction and in the opposite one
};

Column point_gradient(Expr e, std::span<const Expr> symbols, AtKinks at_kinks);

}  // namespace anholon
