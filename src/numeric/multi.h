// A multiprecision real (MPFR) with the operators of a built-in number.
//
// Every value is made with the working precision of its thread, set by PrecisionScope.
// Rounding is to nearest, so results do not depend on anything but the precision.
#pragma once
#include <string>
#include <utility>

#include <mpfr.h>

#include "numeric/rational.h"

namespace anholon {

class Multi {
 public:
  static mpfr_prec_t& working_bits();

  Multi() {
    init();
    mpfr_set_zero(v_, 1);
  }
  Multi(double d) {
    init();
    mpfr_set_d(v_, d, MPFR_RNDN);
  }
  Multi(int i) {
    init();
    mpfr_set_si(v_, i, MPFR_RNDN);
  }
  explicit Multi(long double d) {
    init();
    mpfr_set_ld(v_, d, MPFR_RNDN);
  }
  explicit Multi(const Rational& r) {
    init();
    mpfr_set_q(v_, r.get_mpq().get_mpq_t(), MPFR_RNDN);
  }
  Multi(const Multi& o) {
    init();
    mpfr_set(v_, o.v_, MPFR_RNDN);
  }
  Multi(Multi&& o) noexcept {
    init();
    mpfr_swap(v_, o.v_);
  }
  Multi& operator=(const Multi& o) {
    if (this != &o) mpfr_set(v_, o.v_, MPFR_RNDN);
    return *this;
  }
  Multi& operator=(Multi&& o) noexcept {
    mpfr_swap(v_, o.v_);
    return *this;
  }
  ~Multi() { mpfr_clear(v_); }

  Multi& operator+=(const Multi& o) {
    mpfr_add(v_, v_, o.v_, MPFR_RNDN);
    return *this;
  }
  Multi& operator-=(const Multi& o) {
    mpfr_sub(v_, v_, o.v_, MPFR_RNDN);
    return *this;
  }
  Multi& operator*=(const Multi& o) {
    mpfr_mul(v_, v_, o.v_, MPFR_RNDN);
    return *this;
  }
  Multi& operator/=(const Multi& o) {
    mpfr_div(v_, v_, o.v_, MPFR_RNDN);
    return *this;
  }
  friend Multi operator+(Multi a, const Multi& b) { return std::move(a += b); }
  friend Multi operator-(Multi a, const Multi& b) { return std::move(a -= b); }
  friend Multi operator*(Multi a, const Multi& b) { return std::move(a *= b); }
  friend Multi operator/(Multi a, const Multi& b) { return std::move(a /= b); }
  friend Multi operator-(Multi a) {
    mpfr_neg(a.v_, a.v_, MPFR_RNDN);
    return a;
  }
  friend bool operator==(const Multi& a, const Multi& b) { return mpfr_equal_p(a.v_, b.v_) != 0; }
  friend bool operator<(const Multi& a, const Multi& b) { return mpfr_less_p(a.v_, b.v_) != 0; }
  friend bool operator>(const Multi& a, const Multi& b) { return b < a; }
  friend bool operator<=(const Multi& a, const Multi& b) { return mpfr_lessequal_p(a.v_, b.v_) != 0; }
  friend bool operator>=(const Multi& a, const Multi& b) { return b <= a; }

  double to_double() const { return mpfr_get_d(v_, MPFR_RNDN); }
  long double to_long_double() const { return mpfr_get_ld(v_, MPFR_RNDN); }
  bool finite() const { return mpfr_number_p(v_) != 0; }
  // Returns scientific notation with `digits` significant digits.
  std::string to_string(int digits) const;

  mpfr_ptr raw() { return v_; }
  mpfr_srcptr raw() const { return v_; }

 private:
  void init() { mpfr_init2(v_, working_bits()); }
  mpfr_t v_;
};

// Sets the working precision of the current thread for its lifetime.
class PrecisionScope {
 public:
  explicit PrecisionScope(int decimal_digits) : before_(std::exchange(Multi::working_bits(), bits(decimal_digits))) {}
  ~PrecisionScope() { Multi::working_bits() = before_; }
  PrecisionScope(const PrecisionScope&) = delete;
  PrecisionScope& operator=(const PrecisionScope&) = delete;

 private:
  static mpfr_prec_t bits(int digits) { return static_cast<mpfr_prec_t>(digits * 3.3219281) + 8; }
  mpfr_prec_t before_;
};

#define FUNCTION(name, mpfr_name, arb_name)                                                                            \
  inline Multi name(const Multi& x) {                                                                                  \
    Multi r;                                                                                                           \
    mpfr_name(r.raw(), x.raw(), MPFR_RNDN);                                                                            \
    return r;                                                                                                          \
  }
#include "numeric/functions.def"
#undef FUNCTION
inline Multi abs(const Multi& x) {
  Multi r;
  mpfr_abs(r.raw(), x.raw(), MPFR_RNDN);
  return r;
}
inline Multi pow(const Multi& x, const Multi& y) {
  Multi r;
  mpfr_pow(r.raw(), x.raw(), y.raw(), MPFR_RNDN);
  return r;
}
inline Multi atan2(const Multi& y, const Multi& x) {
  Multi r;
  mpfr_atan2(r.raw(), y.raw(), x.raw(), MPFR_RNDN);
  return r;
}

}  // namespace anholon
