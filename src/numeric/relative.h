// How far something that has to vanish is from zero, in relation to what it is the sum of.
//
// Where all terms of a sum are round-off themselves (a motion at rest, a velocity that has to be zero and is), their
// ratio means nothing. So what does not exceed the round-off of the numbers that the terms come from counts in relation
// to those.
#pragma once
#include "numeric/number.h"

namespace anholon {

// A sum is known to so many round-offs of what it is made of: some hundred operations lead to it.
inline constexpr int kRoundoffsOfSum = 256;

// `made_of`: a function that gives the size of the numbers the terms come from; it is asked only where the terms alone
// do not show that `miss` is small.
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
