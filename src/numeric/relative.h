// The size of a residual, a sum that should vanish, relative to the terms of the sum.
//
// If all terms of a sum are round-off themselves (a motion at rest), their ratio means nothing. A residual within the
// round-off of the numbers behind the terms is therefore measured relative to those numbers.
#pragma once
#include "numeric/number.h"

namespace anholon {

// The error of a sum in units of the round-off of its terms, to which some hundred operations contribute.
inline constexpr int kRoundoffsOfSum = 256;

// Returns the relative residual. `made_of`: a function that returns the size of the numbers behind the terms. It is
// called only if the terms alone do not show that `miss` is small.
template <Number N, class MadeOf>
N relative_miss(const N& miss, const N& terms, MadeOf made_of) {
  constexpr int kFew = 4;
  if (!(abs(miss) > N(0))) return abs(miss);
  if (abs(miss) <= unit_roundoff<N>() * N(kFew) * terms) return abs(miss) / terms;
  const N size = made_of();
  if (is_finite(size) && size > terms && abs(miss) <= unit_roundoff<N>() * N(kRoundoffsOfSum) * size)
    return abs(miss) / size;
  return terms > N(0) ? N(abs(miss) / terms) : N(1);
}

}  // namespace anholon
