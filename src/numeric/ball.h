// A real number enclosed in a ball: midpoint and radius (Arb), with the operators of a built-in number. The result
// contains the exact result for all points of the operands.
//
// Every operation works with the precision of its thread, set by BallScope. If an operation is not defined on the whole
// ball, the result is not finite. Comparisons are therefore functions (contains_zero), not operators.
#pragma once
#include <optional>
#include <string>
#include <utility>

#include <arb.h>

#include "numeric/multi.h"
#include "numeric/quad.h"
#include "numeric/rational.h"

namespace anholon {

class Ball {
 public:
  static slong& working_bits();

  Ball() { arb_init(v_); }
  Ball(int i) {
    arb_init(v_);
    arb_set_si(v_, i);
  }
  explicit Ball(long double x);                            // exactly x
  explicit Ball(Quad x);                                   // exactly x
  explicit Ball(const Multi& x);                           // exactly x
  explicit Ball(const Rational& r);                        // encloses r; exactly r if the precision allows
  Ball(const Rational& midpoint, const Rational& radius);  // encloses [midpoint - radius, midpoint + radius]
  Ball(const Ball& o) {
    arb_init(v_);
    arb_set(v_, o.v_);
  }
  Ball(Ball&& o) noexcept {
    arb_init(v_);
    arb_swap(v_, o.v_);
  }
  Ball& operator=(const Ball& o) {
    arb_set(v_, o.v_);
    return *this;
  }
  Ball& operator=(Ball&& o) noexcept {
    arb_swap(v_, o.v_);
    return *this;
  }
  ~Ball() { arb_clear(v_); }

  Ball& operator+=(const Ball& o) {
    arb_add(v_, v_, o.v_, working_bits());
    return settle();
  }
  Ball& operator-=(const Ball& o) {
    arb_sub(v_, v_, o.v_, working_bits());
    return settle();
  }
  Ball& operator*=(const Ball& o) {
    arb_mul(v_, v_, o.v_, working_bits());
    return settle();
  }
  Ball& operator/=(const Ball& o) {
    arb_div(v_, v_, o.v_, working_bits());
    return settle();
  }
  friend Ball operator+(Ball a, const Ball& b) { return std::move(a += b); }
  friend Ball operator-(Ball a, const Ball& b) { return std::move(a -= b); }
  friend Ball operator*(Ball a, const Ball& b) { return std::move(a *= b); }
  friend Ball operator/(Ball a, const Ball& b) { return std::move(a /= b); }
  friend Ball operator-(Ball a) {
    arb_neg(a.v_, a.v_);
    return a;
  }

  static Ball pi();
  // Returns the whole real line, the enclosure of an undefined value.
  static Ball unknown();

  bool is_finite() const { return arb_is_finite(v_) != 0; }
  bool is_zero() const { return arb_is_zero(v_) != 0; }  // exactly the number 0
  bool contains_zero() const { return arb_contains_zero(v_) != 0; }
  bool is_positive() const { return arb_is_positive(v_) != 0; }
  bool contains(const Rational& r) const;
  bool contains_inside(const Ball& o) const { return arb_contains_interior(v_, o.v_) != 0; }  // o in the open ball
  bool overlaps(const Ball& o) const { return arb_overlaps(v_, o.v_) != 0; }

  // center() is the midpoint as a ball of radius 0; spread() is the ball around 0 of the same radius.
  Ball center() const;
  Ball spread() const;
  // Returns the ball around 0 that contains this one and its mirror image.
  Ball symmetric() const;
  // Return the exact value as a dyadic number; nullopt if it is not finite or its exponent is out of bounds.
  std::optional<Rational> midpoint() const;
  std::optional<Rational> radius() const;
  Multi midpoint_multi() const;  // rounded to Multi's precision
  // Return "0.3333", "1.2e-30"; the radius is rounded upwards.
  std::string midpoint_text(int digits = 16) const;
  std::string radius_text() const;
  // Returns a bound of the absolute value, rounded upwards: "3.14e-15", "0", or "inf" for an unbounded ball.
  std::string bound_text() const;

  // Replaces a ball whose exponent exceeds a machine word by unknown(), so that no chain of operations can exhaust the
  // memory.
  Ball& settle();
  arb_ptr raw() { return v_; }
  arb_srcptr raw() const { return v_; }

 private:
  arb_t v_;
};

// Sets the working precision of balls in the current thread for its lifetime.
class BallScope {
 public:
  explicit BallScope(slong bits) : before_(std::exchange(Ball::working_bits(), bits)) {}
  ~BallScope() { Ball::working_bits() = before_; }
  BallScope(const BallScope&) = delete;
  BallScope& operator=(const BallScope&) = delete;

 private:
  slong before_;
};

#define FUNCTION(name, mpfr_name, arb_name)                                                                            \
  inline Ball name(const Ball& x) {                                                                                    \
    Ball r;                                                                                                            \
    arb_name(r.raw(), x.raw(), Ball::working_bits());                                                                  \
    return std::move(r.settle());                                                                                      \
  }
#include "numeric/functions.def"
#undef FUNCTION
Ball abs(const Ball& x);
Ball max(const Ball& x, const Ball& y);
Ball hull(const Ball& x, const Ball& y);  // holds both
Ball lower_end(const Ball& x);            // rounded downwards
inline void addmul(Ball& acc, const Ball& a, const Ball& b) {
  arb_addmul(acc.raw(), a.raw(), b.raw(), Ball::working_bits());
  acc.settle();
}
Ball sign(const Ball& x);                           // -1, 0, 1, or a ball that holds the possible values
Ball pow(const Ball& x, const Rational& exponent);  // a negative base needs an integer exponent
Ball atan2(const Ball& y, const Ball& x);           // in (-pi, pi]

}  // namespace anholon
