// One trait for all number types on which the numerics run: double, long double, Quad, Multi.
//
// Algorithms are written once, as templates over N, with unqualified sin, sqrt, … found for each type; the functions
// below supply what the built-in types lack.
#pragma once
#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <string>

#include "numeric/multi.h"
#include "numeric/quad.h"
#include "numeric/rational.h"

namespace anholon {

using std::abs, std::atan2, std::pow;
#define FUNCTION(name, mpfr_name, arb_name) using std::name;
#include "numeric/functions.def"
#undef FUNCTION

template <class N>
concept Number =
    std::same_as<N, double> || std::same_as<N, long double> || std::same_as<N, Quad> || std::same_as<N, Multi>;

// Returns the number of bits of the significand.
template <Number N>
long significand_bits() {
  if constexpr (std::same_as<N, Multi>)
    return Multi::working_bits();
  else if constexpr (std::same_as<N, Quad>)
    return kQuadBits;
  else
    return std::numeric_limits<N>::digits;
}

// Returns the unit round-off: half the distance from 1 to the next number.
template <Number N>
N unit_roundoff() {
  if constexpr (std::same_as<N, Multi>) {
    Multi r(1);
    mpfr_div_2ui(r.raw(), r.raw(), static_cast<unsigned long>(Multi::working_bits()), MPFR_RNDN);
    return r;
  } else if constexpr (std::same_as<N, Quad>) {
    return 0x1p-113L;
  } else {
    return std::numeric_limits<N>::epsilon() / 2;
  }
}

// Returns the number nearest to r.
template <Number N>
N from_rational(const Rational& r) {
  if constexpr (std::same_as<N, Multi>) {
    return Multi(r);
  } else {
    // A quotient of two whole numbers that N holds is rounded once.
    if constexpr (!std::same_as<N, Quad>) {
      constexpr long kHeld = 1L << std::min(std::numeric_limits<N>::digits, 62);
      if (r.fits_long())
        if (const long num = r.to_long(), den = r.long_denominator(); num <= kHeld && num >= -kHeld && den <= kHeld)
          return static_cast<N>(num) / static_cast<N>(den);
    }
    // mpq_get_d truncates, and there is no conversion to long double: the conversion uses MPFR, which rounds.
    mpfr_t v;
    mpfr_init2(v, significand_bits<N>());
    mpfr_set_q(v, r.get_mpq().get_mpq_t(), MPFR_RNDN);
    N n;
    if constexpr (std::same_as<N, Quad>)
      n = quad_of(v);
    else
      n = static_cast<N>(mpfr_get_ld(v, MPFR_RNDN));
    mpfr_clear(v);
    return n;
  }
}

inline double to_double(double x) { return x; }
inline double to_double(long double x) { return static_cast<double>(x); }
inline double to_double(Quad x) { return static_cast<double>(x); }
inline double to_double(const Multi& x) { return x.to_double(); }

inline bool is_finite(double x) { return std::isfinite(x); }
inline bool is_finite(long double x) { return std::isfinite(x); }
inline bool is_finite(const Multi& x) { return x.finite(); }

template <Number N>
N sign(const N& x) {
  return x > N(0) ? N(1) : x < N(0) ? N(-1) : N(0);
}

template <Number N>
N pi() {
  if constexpr (std::same_as<N, Multi>) {
    Multi r;
    mpfr_const_pi(r.raw(), MPFR_RNDN);
    return r;
  } else if constexpr (std::same_as<N, Quad>) {
    mpfr_t r;
    mpfr_init2(r, kQuadBits);
    mpfr_const_pi(r, MPFR_RNDN);
    const Quad x = quad_of(r);
    mpfr_clear(r);
    return x;
  } else {
    return static_cast<N>(3.14159265358979323846264338327950288L);
  }
}

// Computes acc += a * b, rounded after the product and after the sum in every type.
template <Number N>
inline void addmul(N& acc, const N& a, const N& b) {
  if constexpr (std::same_as<N, Multi>) {
    thread_local Multi product;
    mpfr_set_prec(product.raw(), Multi::working_bits());
    mpfr_mul(product.raw(), a.raw(), b.raw(), MPFR_RNDN);
    mpfr_add(acc.raw(), acc.raw(), product.raw(), MPFR_RNDN);
  } else {
    acc += a * b;
  }
}

// The type in which a state is stored while its Taylor coefficients are computed in N: the next wider type if the
// machine computes with it as fast, else N.
template <Number N>
struct WiderType {
  using type = N;
};
template <>
struct WiderType<double> {
  using type = long double;
};
template <Number N>
using Wider = typename WiderType<N>::type;

template <Number To, Number From>
To convert(const From& x) {
  if constexpr (std::same_as<To, From>) {
    return x;
  } else if constexpr (std::same_as<To, Multi> && std::same_as<From, Quad>) {
    Multi m;
    set_mpfr(m.raw(), x);
    return m;
  } else {
    return static_cast<To>(x);
  }
}

// Returns a decimal text that reads back to the same number (built-in types and Quad), or one with `digits` significant
// digits (Multi, or if digits > 0).
std::string number_text(double x, int digits = 0);
std::string number_text(long double x, int digits = 0);
std::string number_text(Quad x, int digits = 0);
std::string number_text(const Multi& x, int digits = 0);
// Returns a text with two digits more than `digits`, the digits that the user requested, up to the digits of a Quad;
// all digits if `digits` is at most 16.
std::string quad_text(Quad x, int digits);
// Returns an exact text of the number, in decimal digits or as a fraction, if there is a short one; else the digits of
// the nearest double.
std::string exact_text_if_short(const Rational& r);

}  // namespace anholon
