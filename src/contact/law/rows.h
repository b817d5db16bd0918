// Rows of numbers, and the limit below which they count as zero.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

namespace anholon {

using ContactNumbers = std::vector<long double>;

// Solutions with a smaller difference, relative to their size, are the same; a smaller pivot is zero.
inline constexpr long double kSame = 1e-10L;

inline long double dot(const ContactNumbers& a, const ContactNumbers& b) {
  long double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

inline long double largest(const ContactNumbers& a) {
  long double most = 0;
  for (long double x : a) most = std::max(most, std::abs(x));
  return most;
}

}  // namespace anholon
