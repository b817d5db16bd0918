#include "numeric/quad.h"

#include <cmath>

namespace anholon {

namespace {

// An MPFR number of 113 bits.
struct Exact {
  mpfr_t v;
  Exact() { mpfr_init2(v, kQuadBits); }
  explicit Exact(Quad x) : Exact() { set_mpfr(v, x); }
  ~Exact() { mpfr_clear(v); }
  Exact(const Exact&) = delete;
  Exact& operator=(const Exact&) = delete;
};

using Rounded = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t);

Quad apply(Rounded f, Quad x) {
  Exact u(x);
  f(u.v, u.v, MPFR_RNDN);
  return quad_of(u.v);
}

}  // namespace

// Two long doubles of 64 bits hold the 113 bits of a Quad, in the same range of exponents.
void set_mpfr(mpfr_ptr to, Quad x) {
  const long double high = static_cast<long double>(x);
  mpfr_set_ld(to, high, MPFR_RNDN);
  if (!std::isfinite(high)) return;
  const long double low = static_cast<long double>(x - high);
  if (low == 0) return;
  mpfr_t rest;
  mpfr_init2(rest, 64);
  mpfr_set_ld(rest, low, MPFR_RNDN);
  mpfr_add(to, to, rest, MPFR_RNDN);
  mpfr_clear(rest);
}

Quad quad_of(mpfr_srcptr x) {
  const long double high = mpfr_get_ld(x, MPFR_RNDN);
  if (!std::isfinite(high)) return high;
  mpfr_t rest;
  mpfr_init2(rest, kQuadBits + 64);
  mpfr_set_ld(rest, high, MPFR_RNDN);
  mpfr_sub(rest, x, rest, MPFR_RNDN);
  const long double low = mpfr_get_ld(rest, MPFR_RNDN);
  mpfr_clear(rest);
  // If low is 0, high is x with its sign: -0 stays -0.
  return low == 0 ? static_cast<Quad>(high) : static_cast<Quad>(high) + low;
}

#define FUNCTION(name, mpfr_name, arb_name)                                                                            \
  Quad name(Quad x) { return apply(mpfr_name, x); }
#include "numeric/functions.def"
#undef FUNCTION

Quad pow(Quad x, Quad y) {
  Exact u(x), v(y);
  mpfr_pow(u.v, u.v, v.v, MPFR_RNDN);
  return quad_of(u.v);
}

Quad atan2(Quad y, Quad x) {
  Exact u(y), v(x);
  mpfr_atan2(u.v, u.v, v.v, MPFR_RNDN);
  return quad_of(u.v);
}

}  // namespace anholon
