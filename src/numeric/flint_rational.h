// Rational numbers as arguments of FLINT's functions.
#pragma once
#include <cstddef>
#include <type_traits>

#include <flint/fmpq.h>

#include "numeric/rational.h"

namespace anholon {

// A Rational is laid out as an `fmpq`, whose members are two numbers of type `long`.
struct FlintRational {
  static fmpq* of(Rational& r) { return reinterpret_cast<fmpq*>(&r); }
  static const fmpq* of(const Rational& r) { return reinterpret_cast<const fmpq*>(&r); }

 private:
  static_assert(std::is_same_v<fmpz, long> && sizeof(fmpq) == sizeof(Rational));
  static_assert(offsetof(Rational, num_) == offsetof(fmpq, num) && offsetof(Rational, den_) == offsetof(fmpq, den));
  static_assert(Rational::kMost == COEFF_MAX && -Rational::kMost == COEFF_MIN);
  static_assert(COEFF_IS_MPZ(1L << 62) && !Rational::in_place(1L << 62) && Rational::in_place(COEFF_MIN));
};

}  // namespace anholon
