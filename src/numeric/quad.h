// Quadruple precision: the compiler's number of 113 bits, with the functions that the language lacks for it.
//
// Sums, products and quotients are the compiler's own (whole numbers underneath, correctly rounded). Elementary
// functions go through MPFR: correctly rounded too, the same bits with every compiler, and a motion needs them at order
// 0 of its Taylor series only.
#pragma once
#include <mpfr.h>

namespace anholon {

__extension__ typedef __float128 Quad;

inline constexpr int kQuadBits = 113;
inline constexpr int kQuadDigits = 33;      // decimal digits that a Quad always holds
inline constexpr int kQuadTextDigits = 36;  // digits that distinguish any two Quads

// Stores x, exactly if `to` has at least 113 bits; the other function returns the Quad nearest to a number of at most
// 113 bits.
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
