// Rows of numbers, and what counts as zero among them.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

namespace anholon {

using ContactNumbers = std::vector<long double>;

// Solutions that differ by less, in relation to their size, are the same; a pivot below it is zero.
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
