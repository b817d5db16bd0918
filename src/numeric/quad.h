// Quadruple precision: the compiler's number of 113 bits, with the functions that the language lacks for it.
//
// The compiler's own sums, products and quotients (whole numbers underneath) are correctly rounded. Elementary
// functions use MPFR: they are correctly rounded as well, have the same bits with every compiler, and a motion needs
// them only at order 0 of its Taylor series.
#pragma once
#include <mpfr.h>

namespace anholon {

__extension__ typedef __float128 Quad;

inline constexpr int kQuadBits = 113;
inline constexpr int kQuadDigits = 33;      // decimal digits that a Quad always holds
inline constexpr int kQuadTextDigits = 36;  // digits that distinguish any two Quads

// set_mpfr stores x, exactly if `to` has at least 113 bits; quad_of returns the Quad nearest to a number of at most 113
// bits.
void set_mpfr(mpfr_ptr to, Quad x);
Quad quad_of(mpfr_srcptr x);

inline Quad abs(Quad x) { return __builtin_fabsf128(x); }
inline bool is_finite(Quad x) { return x - x == 0; }

#define FUNCTION(name, mpfr_name, arb_name) Quad name(Quad x);
#include "numeric/functions.def"
#undef FUNCTION
Quad pow(Quad x, Quad y);
Quad atan2(Quad y, Quad x);

}  // namespace anholon
