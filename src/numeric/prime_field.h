// Arithmetic modulo a prime near 2^61.
#pragma once
#include <cstdint>
#include <optional>

#include "numeric/rational.h"

namespace anholon {

// The field of p elements, 2^61 − 2^30 < p < 2^61.
class PrimeField {
 public:
  using Word = std::uint64_t;
  explicit PrimeField(Word p) : p_(p), c_((Word{1} << 61) - p) {}
  Word prime() const { return p_; }
  Word add(Word a, Word b) const {
    const Word s = a + b;
    return s >= p_ ? s - p_ : s;
  }
  Word subtract(Word a, Word b) const { return a >= b ? a - b : a + p_ - b; }
  Word negate(Word a) const { return a == 0 ? 0 : p_ - a; }
  Word multiply(Word a, Word b) const {
    const unsigned __int128 x = static_cast<unsigned __int128>(a) * b;
    const unsigned __int128 y =
        static_cast<unsigned __int128>(static_cast<Word>(x >> 61)) * c_ + (static_cast<Word>(x) & kMask);
    Word z = static_cast<Word>(y >> 61) * c_ + (static_cast<Word>(y) & kMask);
    while (z >= p_) z -= p_;
    return z;
  }
  Word power(Word a, Word exponent) const;
  Word inverse(Word a) const { return power(a, p_ - 2); }  // REQUIRES: a ≠ 0
  bool is_square(Word a) const { return a == 0 || power(a, (p_ - 1) / 2) == 1; }
  std::optional<Word> from(const Rational& r) const;  // nullopt if p divides the denominator

 private:
  static constexpr Word kMask = (Word{1} << 61) - 1;
  Word p_, c_;
};

}  // namespace anholon
