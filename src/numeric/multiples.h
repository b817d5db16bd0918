// Whole multiples of a rational number.
#pragma once
#include <algorithm>
#include <concepts>
#include <limits>

#include "numeric/number.h"

namespace anholon {

// Computes k times a rational number, rounded once.
template <Number N>
class Multiples {
 public:
  explicit Multiples(const Rational& of) : of_(of) {
    if (std::floating_point<N> && of.fits_long()) num_ = of.to_long(), den_ = of.long_denominator();
  }

  N operator()(long k) const {
    // A quotient of two whole numbers that N holds is rounded once.
    if constexpr (std::floating_point<N>) {
      constexpr long kHeld = 1L << std::min(std::numeric_limits<N>::digits, 62);
      long product = 0;
      if (den_ > 0 && den_ <= kHeld && !__builtin_mul_overflow(k, num_, &product) && product <= kHeld &&
          product >= -kHeld)
        return static_cast<N>(product) / static_cast<N>(den_);
    }
    return from_rational<N>(Rational(k * of_));
  }

 private:
  Rational of_;
  long num_ = 0, den_ = 0;  // those of the number; both are 0 if one of them is too large
};

}  // namespace anholon
