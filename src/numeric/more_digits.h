// How many digits a hint suggests where those of a number type are too few.
#pragma once
#include <limits>

#include "numeric/number.h"

namespace anholon {

// Whether N has more digits than the numbers of the machine: more digits were asked for.
template <Number N>
bool has_many_digits() {
  return significand_bits<N>() > std::numeric_limits<long double>::digits;
}

// The N of `--digits N` to suggest: 30, and about twice the digits of N if it has many.
template <Number N>
int more_digits() {
  constexpr double kDigitsOfBit = 0.30103;
  const int twice = static_cast<int>(2 * kDigitsOfBit * static_cast<double>(significand_bits<N>()));
  return has_many_digits<N>() ? (twice + 9) / 10 * 10 : 30;
}

}  // namespace anholon
