// The number of digits that a hint suggests if those of a number type are too few.
#pragma once
#include <limits>

#include "numeric/number.h"

namespace anholon {

// True if N has more digits than long double, because the user requested more digits.
template <Number N>
bool has_many_digits() {
  return significand_bits<N>() > std::numeric_limits<long double>::digits;
}

// Returns the N of `--digits N` to suggest: 30, or about twice the digits of N if it has many.
template <Number N>
int more_digits() {
  constexpr double kDigitsOfBit = 0.30103;
  const int twice = static_cast<int>(2 * kDigitsOfBit * static_cast<double>(significand_bits<N>()));
  return has_many_digits<N>() ? (twice + 9) / 10 * 10 : 30;
}

}  // namespace anholon
