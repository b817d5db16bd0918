// Sums with numbers that are out of the range of double.
//
// The graph writes a sum with whole coefficients, 1 + 1e-34 y as 1e-34 (1e34 + y). Its tenth power is then 1e-340 (1e34 + y)^10,
// a product of two numbers that no double holds. A tape computes such a sum in units of its largest coefficient, by which the
// coefficient in front of the product grows.
#pragma once
#include <span>
#include <unordered_set>

#include "expr/expr.h"

namespace anholon {

// Numbers up to 2^256 are stored unchanged.
inline constexpr long kLargestExponent = 256;

// Returns the sums among these nodes whose coefficients are beyond 2^256, alone or in products.
std::unordered_set<NodeId> large_sums(const Graph& g, std::span<const NodeId> nodes);

// Returns a k with 2^(k-1) < |r| < 2^(k+1). REQUIRES: r != 0.
long binary_exponent(const Rational& r);

// Returns 2^k r.
Rational times_power_of_two(const Rational& r, long k);

}  // namespace anholon
