// Finds the first point at which a polynomial passes from one sign to the other, without missing one.
//
// In Bernstein form on [0, h] a polynomial lies within the hull of its coefficients. Intervals on which the hull stays
// on one side need no search; others are halved, the earlier half first (de Casteljau).
#pragma once
#include <optional>
#include <vector>

#include "numeric/number.h"

namespace anholon {

// The sum of c_k x^k, k = 0..degree, by Horner's scheme.
template <Number N>
N value_at(const N* c, int degree, const N& x) {
  N s(0);
  for (int k = degree; k >= 0; --k) s = s * x + c[k];
  return s;
}

// Bernstein coefficients on [0, 1] of sum a_k u^k: b_j = sum_{k<=j} C(j,k)/C(n,k) a_k.
template <Number N>
std::vector<N> bernstein(std::vector<N> a) {
  const std::size_t n = a.size() - 1;
  N binomial(1);  // C(n, k)
  for (std::size_t k = 1; k <= n; ++k) {
    binomial = binomial * N(static_cast<int>(n - k + 1)) / N(static_cast<int>(k));
    a[k] = a[k] / binomial;
  }
  // Sums with binomial weights, in place: k rounds of adding the neighbour below.
  for (std::size_t k = 1; k <= n; ++k)
    for (std::size_t j = n; j >= k; --j) a[j] += a[j - 1];
  return a;
}

// Returns the first x in (0, h], h of either sign, from which on p = sum c_k x^k is below -floor, moved back to where p
// left the side p >= 0; 0 if p is below -floor at 0. A p that stays above -floor only touches zero.
template <Number N>
std::optional<N> first_below(const N* c, int degree, const N& h, const N& floor);

// The logarithm of the distance over which the sum of c_k x^k is known by its first terms: the last two terms stay
// below the tolerance times the greatest of the terms before them and of `floor`, the round-off. It is 300, as for a
// step, if nothing bounds the distance.
template <Number N>
double log_reach(const N* c, int degree, const N& floor, double log_tolerance);

}  // namespace anholon
