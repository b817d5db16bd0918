// Exact rational numbers and the decimal text that denotes them.
#pragma once
#include <compare>
#include <concepts>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <flint/fmpq.h>
#include <gmpxx.h>

namespace anholon {

// An exact rational number in lowest terms with a positive denominator. FLINT stores a numerator or denominator of at
// most 62 bits in place, so that numbers of this size, almost all of those in formulas, take no memory of their own.
// The members named `get_…` are called as those of GMP's classes. Division by zero is a broken invariant.
class Rational {
 public:
  Rational() { fmpq_init(q_); }
  template <std::integral T>
  Rational(T n) {
    set(num(), n);
    *den() = 1;
  }
  template <std::integral P, std::integral Q>
  Rational(P p, Q q) : Rational(p) {
    if (!(q == 1)) *this /= Rational(q);
  }
  Rational(const mpz_class& n);
  Rational(const mpz_class& p, const mpz_class& q);
  // The number that the floating-point number is.
  explicit Rational(double x);
  // "p" or "p/q" in decimal digits.
  explicit Rational(const char* text);
  static Rational from(const mpq_class& r);
  static Rational from(const fmpq_t r);

  Rational(const Rational& r) {
    fmpz_init_set(num(), r.num());
    fmpz_init_set(den(), r.den());
  }
  Rational(Rational&& r) noexcept {
    *q_ = *r.q_;
    fmpq_init(r.q_);
  }
  Rational& operator=(const Rational& r) {
    fmpz_set(num(), r.num());
    fmpz_set(den(), r.den());
    return *this;
  }
  Rational& operator=(Rational&& r) noexcept {
    std::swap(*q_, *r.q_);
    return *this;
  }
  ~Rational() {
    fmpz_clear(num());
    fmpz_clear(den());
  }

  mpz_class get_num() const { return integer(num()); }
  mpz_class get_den() const { return integer(den()); }
  bool is_integer() const { return *den() == 1; }
  bool has_even_denominator() const { return fmpz_is_even(den()) != 0; }
  // These two are compiled in place altogether: the compiler module, which is not linked with FLINT, asks them.
  bool is_one() const { return *num() == 1 && *den() == 1; }
  bool is_minus_one() const { return *num() == -1 && *den() == 1; }
  // Whether numerator and denominator are numbers of type `long`.
  bool fits_long() const {
    return !COEFF_IS_MPZ(*num() | *den()) || (fmpz_fits_si(num()) != 0 && fmpz_fits_si(den()) != 0);
  }
  // The numerator. REQUIRES: it is a number of type `long`.
  long to_long() const { return fmpz_get_si(num()); }
  // The denominator. REQUIRES: it is a number of type `long`.
  long long_denominator() const { return fmpz_get_si(den()); }
  // Numerator and denominator modulo p.
  std::pair<std::uint64_t, std::uint64_t> modulo(std::uint64_t p) const {
    return {fmpz_fdiv_ui(num(), p), fmpz_fdiv_ui(den(), p)};
  }
  // The bits, and the machine words, of numerator and denominator together.
  std::uint64_t bits() const { return fmpz_bits(num()) + fmpz_bits(den()); }
  std::size_t limbs() const { return fmpz_size(num()) + fmpz_size(den()); }
  // The nearest double towards zero.
  double get_d() const;
  std::string get_str(int base = 10) const;
  mpq_class get_mpq() const;
  fmpq* fraction() { return q_; }
  const fmpq* fraction() const { return q_; }
  std::uint64_t hash() const;

  Rational& operator+=(const Rational& r) {
    if (long sum; whole() && r.whole() && !__builtin_add_overflow(*num(), *r.num(), &sum) && in_place(sum))
      *num() = sum;
    else
      fmpq_add(q_, q_, r.q_);
    return *this;
  }
  Rational& operator-=(const Rational& r) {
    if (long rest; whole() && r.whole() && !__builtin_sub_overflow(*num(), *r.num(), &rest) && in_place(rest))
      *num() = rest;
    else
      fmpq_sub(q_, q_, r.q_);
    return *this;
  }
  Rational& operator*=(const Rational& r) {
    if (long product; whole() && r.whole() && !__builtin_mul_overflow(*num(), *r.num(), &product) && in_place(product))
      *num() = product;
    else
      fmpq_mul(q_, q_, r.q_);
    return *this;
  }
  Rational& operator/=(const Rational& r) {
    if (!(r == 1)) fmpq_div(q_, q_, r.q_);
    return *this;
  }

  friend Rational operator+(Rational a, const Rational& b) { return std::move(a += b); }
  friend Rational operator-(Rational a, const Rational& b) { return std::move(a -= b); }
  friend Rational operator*(Rational a, const Rational& b) { return std::move(a *= b); }
  friend Rational operator/(Rational a, const Rational& b) { return std::move(a /= b); }
  friend Rational operator-(Rational a) {
    fmpz_neg(a.num(), a.num());
    return a;
  }
  friend Rational abs(Rational a) {
    fmpz_abs(a.num(), a.num());
    return a;
  }
  friend int sgn(const Rational& a) { return fmpz_sgn(a.num()); }
  friend int cmp(const Rational& a, const Rational& b) {
    if (a.whole() && b.whole()) return *a.num() < *b.num() ? -1 : *a.num() > *b.num() ? 1 : 0;
    return fmpq_cmp(a.q_, b.q_);
  }
  // The greatest rational of which both are integer multiples; 0 for two zeros.
  friend Rational gcd(Rational a, const Rational& b) {
    fmpq_gcd(a.q_, a.q_, b.q_);
    return a;
  }
  // The greatest integer that is not greater.
  friend Rational floor(const Rational& a);

  friend bool operator==(const Rational& a, const Rational& b) { return fmpq_equal(a.q_, b.q_) != 0; }
  friend std::strong_ordering operator<=>(const Rational& a, const Rational& b) { return cmp(a, b) <=> 0; }
  template <std::integral T>
  friend bool operator==(const Rational& a, T n) {
    return a.whole() ? std::cmp_equal(*a.num(), n) : a == Rational(n);
  }
  template <std::integral T>
  friend std::strong_ordering operator<=>(const Rational& a, T n) {
    return cmp(a, Rational(n)) <=> 0;
  }

 private:
  fmpz* num() { return fmpq_numref(q_); }
  fmpz* den() { return fmpq_denref(q_); }
  const fmpz* num() const { return fmpq_numref(q_); }
  const fmpz* den() const { return fmpq_denref(q_); }
  static bool in_place(long n) { return COEFF_MIN <= n && n <= COEFF_MAX; }
  // An integer that is stored in place.
  bool whole() const { return *den() == 1 && !COEFF_IS_MPZ(*num()); }
  static mpz_class integer(const fmpz* n);

  template <std::integral T>
  static void set(fmpz* to, T n) {
    if constexpr (std::unsigned_integral<T>)
      fmpz_init_set_ui(to, n);
    else
      fmpz_init_set_si(to, n);
  }

  fmpq_t q_;
};

Rational abs(Rational a);
Rational floor(const Rational& a);
std::ostream& operator<<(std::ostream& out, const Rational& r);

// "3", "-0.25", "1e-3", "22/7" exactly; nullopt if the text is not a number, or if it or its exponent is too large for
// a value of reasonable size.
std::optional<Rational> parse_rational(std::string_view text);

// "3", "-1/4".
std::string to_string(const Rational& r);

// ln r of a positive r of any size.
double natural_logarithm(const Rational& r);

// The exact root r^(1/n), if it is rational.
std::optional<Rational> exact_root(const Rational& r, unsigned long n);

// base^exponent for an integer exponent; nullopt for 0^negative or a result of unreasonable size.
std::optional<Rational> exact_power(const Rational& base, long exponent);

}  // namespace anholon
