#include "numeric/ball.h"

#include <limits>

#include "numeric/flint_rational.h"

namespace anholon {

slong& Ball::working_bits() {
  thread_local slong bits = 128;
  return bits;
}

namespace {

// A dyadic number is converted to a Rational if its exponent is within this number of bits.
constexpr slong kLargestExponent = 1 << 20;

std::optional<Rational> exactly(const arf_t x) {
  if (!arf_is_finite(x)) return std::nullopt;
  if (arf_is_zero(x)) return Rational(0);
  if (arf_cmpabs_2exp_si(x, kLargestExponent) > 0 || arf_cmpabs_2exp_si(x, -kLargestExponent) < 0) return std::nullopt;
  Rational r;
  arf_get_fmpq(FlintRational::of(r), x);
  return r;
}

std::string upwards(const arf_t x) {
  if (arf_is_zero(x)) return "0";
  mpfr_t r;
  mpfr_init2(r, 64);
  arf_get_mpfr(r, x, MPFR_RNDU);
  char* text = nullptr;
  mpfr_asprintf(&text, "%.2RUe", r);
  std::string s(text);
  mpfr_free_str(text);
  mpfr_clear(r);
  return s;
}

}  // namespace

Ball::Ball(const Multi& x) {
  arb_init(v_);
  arf_set_mpfr(arb_midref(v_), x.raw());
  if (!arf_is_finite(arb_midref(v_))) arb_indeterminate(v_);
}

Ball::Ball(Quad x) {
  mpfr_t exact;
  mpfr_init2(exact, kQuadBits);
  set_mpfr(exact, x);
  arb_init(v_);
  arf_set_mpfr(arb_midref(v_), exact);
  mpfr_clear(exact);
  if (!arf_is_finite(arb_midref(v_))) arb_indeterminate(v_);
}

Ball::Ball(long double x) {
  mpfr_t exact;
  mpfr_init2(exact, std::numeric_limits<long double>::digits);
  mpfr_set_ld(exact, x, MPFR_RNDN);
  arb_init(v_);
  arf_set_mpfr(arb_midref(v_), exact);
  mpfr_clear(exact);
  if (!arf_is_finite(arb_midref(v_))) arb_indeterminate(v_);
}

Ball::Ball(const Rational& r) {
  arb_init(v_);
  arb_set_fmpq(v_, FlintRational::of(r), working_bits());
}

Ball::Ball(const Rational& midpoint, const Rational& radius) : Ball(midpoint) {
  const Ball r(abs(radius));
  arb_add_error(v_, r.v_);
}

Ball Ball::pi() {
  Ball r;
  arb_const_pi(r.v_, working_bits());
  return r;
}

Ball Ball::unknown() {
  Ball r;
  arb_indeterminate(r.v_);
  return r;
}

bool Ball::contains(const Rational& r) const { return arb_contains_fmpq(v_, FlintRational::of(r)) != 0; }

Ball Ball::center() const {
  Ball r;
  arb_get_mid_arb(r.v_, v_);
  return r;
}

Ball Ball::spread() const {
  Ball r;
  mag_set(arb_radref(r.v_), arb_radref(v_));
  return r;
}

Ball Ball::symmetric() const {
  Ball r;
  arb_get_mag(arb_radref(r.v_), v_);
  return r;
}

std::optional<Rational> Ball::midpoint() const { return exactly(arb_midref(v_)); }

std::optional<Rational> Ball::radius() const {
  arf_t r;
  arf_init_set_mag_shallow(r, arb_radref(v_));
  return exactly(r);
}

Multi Ball::midpoint_multi() const {
  Multi r;
  arf_get_mpfr(r.raw(), arb_midref(v_), MPFR_RNDN);
  return r;
}

std::string Ball::midpoint_text(int digits) const {
  char* text = arf_get_str(arb_midref(v_), digits);
  std::string r(text);
  flint_free(text);
  return r;
}

std::string Ball::radius_text() const {
  arf_t r;
  arf_init_set_mag_shallow(r, arb_radref(v_));
  return upwards(r);
}

std::string Ball::bound_text() const {
  if (!is_finite()) return "inf";
  arf_t bound;
  arf_init(bound);
  arb_get_abs_ubound_arf(bound, v_, 64);
  std::string s = upwards(bound);
  arf_clear(bound);
  return s;
}

Ball& Ball::settle() {
  if (COEFF_IS_MPZ(ARF_EXP(arb_midref(v_))) && !arf_is_special(arb_midref(v_))) arb_indeterminate(v_);
  if (COEFF_IS_MPZ(MAG_EXP(arb_radref(v_))) && !mag_is_special(arb_radref(v_))) arb_indeterminate(v_);
  return *this;
}

Ball abs(const Ball& x) {
  Ball r;
  arb_abs(r.raw(), x.raw());
  if (!arb_contains_zero(x.raw())) return r;
  // arb_abs of a ball around 0 reaches below 0.
  arb_nonnegative_part(r.raw(), r.raw());
  return r;
}

Ball max(const Ball& x, const Ball& y) {
  if (!x.is_finite() || !y.is_finite()) return Ball::unknown();
  Ball r;
  arb_max(r.raw(), x.raw(), y.raw(), Ball::working_bits());
  return r;
}

Ball hull(const Ball& x, const Ball& y) {
  if (!x.is_finite() || !y.is_finite()) return Ball::unknown();
  Ball r;
  arb_union(r.raw(), x.raw(), y.raw(), Ball::working_bits());
  return r;
}

Ball lower_end(const Ball& x) {
  if (!x.is_finite()) return Ball::unknown();
  Ball r;
  arb_get_lbound_arf(arb_midref(r.raw()), x.raw(), Ball::working_bits());
  return r;
}

Ball sign(const Ball& x) {
  if (!x.is_finite()) return Ball::unknown();
  Ball r;
  arb_sgn(r.raw(), x.raw());
  return r;
}

Ball pow(const Ball& x, const Rational& exponent) {
  Ball r;
  arb_pow_fmpq(r.raw(), x.raw(), FlintRational::of(exponent), Ball::working_bits());
  return std::move(r.settle());
}

Ball atan2(const Ball& y, const Ball& x) {
  // atan2 is not defined at the origin, where Arb returns 0.
  if (y.contains_zero() && x.contains_zero()) return Ball::unknown();
  Ball r;
  arb_atan2(r.raw(), y.raw(), x.raw(), Ball::working_bits());
  return std::move(r.settle());
}

}  // namespace anholon
