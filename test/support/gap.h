// The distance of two lists of numbers.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "numeric/number.h"

namespace anholon::test {

// The largest |a_i - b_i| as a double, for lists of equal length in any number type; 0 for empty lists.
template <class N>
double largest_gap(const std::vector<N>& a, const std::vector<N>& b) {
  double gap = 0;
  for (std::size_t i = 0; i < a.size(); ++i) gap = std::max(gap, std::abs(to_double(N(a[i] - b[i]))));
  return gap;
}

}  // namespace anholon::test
