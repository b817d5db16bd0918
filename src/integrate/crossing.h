// The first time at which a polynomial passes from one sign to the other, none stepped over.
//
// In Bernstein form on [0, h] a polynomial lies within the hull of its coefficients. Stretches on which the hull stays on one
// side are passed over whole; others are halved, the earlier half first (de Casteljau).
#pragma once
#include <optional>

#include "numeric/number.h"

namespace anholon {

// The first x in (0, h], h of either sign, from where on p = sum c_k x^k is below -floor, taken back to where p left the side
// p >= 0 (where it does not hold at 0: 0). A dip that stays above -floor is none: p only touches zero there.
template <Number N>
std::optional<N> first_below(const N* c, int degree, const N& h, const N& floor);

}  // namespace anholon
