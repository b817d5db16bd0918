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

#include <gmpxx.h>

namespace anholon {

// An exact rational number in lowest terms with a positive denominator. A numerator or denominator of at most 62 bits,
// like most of those in formulas, is stored in place and needs no memory of its own; FLINT stores the longer ones and
// does the arithmetic with them. The members named `get_…` have the names of members of GMP's classes. Division by zero
// is a broken invariant.
class Rational {
 public:
  Rational() = default;
  template <std::integral T>
  Rational(T n) {
    if constexpr (std::signed_integral<T>)
      fits_in_place(n) ? static_cast<void>(num_ = n) : set_long(n);
    else
      n <= static_cast<unsigned long>(kMost) ? static_cast<void>(num_ = static_cast<long>(n)) : set_unsigned(n);
  }
  template <std::integral P, std::integral Q>
  Rational(P p, Q q) : Rational(p) {
    if (q != Q{1}) *this /= Rational(q);
  }
  Rational(const mpz_class& n);
  Rational(const mpz_class& p, const mpz_class& q);
  // Converts the floating-point number exactly.
  explicit Rational(double x);
  // Reads "p" or "p/q" in decimal digits.
  explicit Rational(const char* text);
  static Rational from(const mpq_class& r);

  Rational(const Rational& r) {
    if (r.is_in_place())
      num_ = r.num_, den_ = r.den_;
    else
      copy(r);
  }
  Rational(Rational&& r) noexcept : num_(std::exchange(r.num_, 0)), den_(std::exchange(r.den_, 1)) {}
  Rational& operator=(const Rational& r) {
    if (is_in_place() && r.is_in_place())
      num_ = r.num_, den_ = r.den_;
    else
      copy(r);
    return *this;
  }
  Rational& operator=(Rational&& r) noexcept {
    std::swap(num_, r.num_), std::swap(den_, r.den_);
    return *this;
  }
  ~Rational() {
    if (!is_in_place()) clear();
  }

  mpz_class get_num() const;
  mpz_class get_den() const;
  bool is_integer() const { return den_ == 1; }
  bool has_even_denominator() const;
  bool is_one() const { return num_ == 1 && den_ == 1; }
  bool is_minus_one() const { return num_ == -1 && den_ == 1; }
  // True if numerator and denominator are numbers of type `long`.
  bool fits_long() const;
  // Return the numerator, and the denominator. REQUIRES: it is a number of type `long`.
  long to_long() const { return in_place(num_) ? num_ : get_num().get_si(); }
  long long_denominator() const { return in_place(den_) ? den_ : get_den().get_si(); }
  // Returns numerator and denominator modulo p.
  std::pair<std::uint64_t, std::uint64_t> modulo(std::uint64_t p) const;
  // Return the number of bits, and of machine words, of numerator and denominator together.
  std::uint64_t bits() const;
  std::size_t limbs() const;
  // Returns the nearest double; the member of GMP's classes truncates.
  double get_d() const;
  std::string get_str(int base = 10) const;
  mpq_class get_mpq() const;
  std::uint64_t hash() const;

  Rational& operator+=(const Rational& r) {
    long sum;
    if (!are_whole(*this, r) || __builtin_add_overflow(num_, r.num_, &sum) || !fits_in_place(sum)) return add(r);
    num_ = sum;
    return *this;
  }
  Rational& operator-=(const Rational& r) {
    long rest;
    if (!are_whole(*this, r) || __builtin_sub_overflow(num_, r.num_, &rest) || !fits_in_place(rest)) return subtract(r);
    num_ = rest;
    return *this;
  }
  Rational& operator*=(const Rational& r) {
    long product;
    if (!are_whole(*this, r) || __builtin_mul_overflow(num_, r.num_, &product) || !fits_in_place(product))
      return multiply(r);
    num_ = product;
    return *this;
  }
  Rational& operator/=(const Rational& r) { return r.is_one() ? *this : divide(r); }

  friend Rational operator+(Rational a, const Rational& b) { return std::move(a += b); }
  friend Rational operator-(Rational a, const Rational& b) { return std::move(a -= b); }
  friend Rational operator*(Rational a, const Rational& b) { return std::move(a *= b); }
  friend Rational operator/(Rational a, const Rational& b) { return std::move(a /= b); }
  friend Rational operator-(Rational a) {
    if (!in_place(a.num_)) return a.negated();
    a.num_ = -a.num_;
    return a;
  }
  friend Rational abs(Rational a) { return sgn(a) < 0 ? -std::move(a) : a; }
  friend int sgn(const Rational& a) { return in_place(a.num_) ? (a.num_ > 0) - (a.num_ < 0) : a.long_sign(); }
  friend int cmp(const Rational& a, const Rational& b) {
    return are_whole(a, b) ? (a.num_ > b.num_) - (a.num_ < b.num_) : a.compare(b);
  }
  // Returns the greatest rational of which both are integer multiples; 0 for two zeros.
  friend Rational gcd(const Rational& a, const Rational& b);
  // Returns the greatest integer that is not greater than a.
  friend Rational floor(const Rational& a);

  friend bool operator==(const Rational& a, const Rational& b) {
    if (a.is_in_place() || b.is_in_place()) return a.num_ == b.num_ && a.den_ == b.den_;
    return a.compare(b) == 0;
  }
  friend std::strong_ordering operator<=>(const Rational& a, const Rational& b) { return cmp(a, b) <=> 0; }
  template <std::integral T>
  friend bool operator==(const Rational& a, T n) {
    return a.den_ == 1 && (in_place(a.num_) ? std::cmp_equal(a.num_, n) : a.compare(Rational(n)) == 0);
  }
  template <std::integral T>
  friend std::strong_ordering operator<=>(const Rational& a, T n) {
    return cmp(a, Rational(n)) <=> 0;
  }

 private:
  friend struct FlintRational;

  // FLINT's rule: bit 62 without bit 63 marks the place of a longer number. The functions above that do not use the
  // functions below are inline, because the compiler module, which is not linked with FLINT, calls some of them.
  static constexpr bool in_place(long n) { return n >> 62 != 1; }
  static constexpr long kMost = (1L << 62) - 1;
  static constexpr bool fits_in_place(long n) { return -kMost <= n && n <= kMost; }
  bool is_in_place() const { return in_place(num_) && in_place(den_); }
  static bool are_whole(const Rational& a, const Rational& b) {
    return a.den_ == 1 && b.den_ == 1 && in_place(a.num_) && in_place(b.num_);
  }

  void set_long(long n);
  void set_unsigned(unsigned long n);
  void copy(const Rational& r);
  void clear();
  Rational& add(const Rational& r);
  Rational& subtract(const Rational& r);
  Rational& multiply(const Rational& r);
  Rational& divide(const Rational& r);
  Rational negated() const;
  int long_sign() const;
  int compare(const Rational& r) const;

  long num_ = 0, den_ = 1;
};

Rational abs(Rational a);
Rational gcd(const Rational& a, const Rational& b);
Rational floor(const Rational& a);
std::ostream& operator<<(std::ostream& out, const Rational& r);

// Reads "3", "-0.25", "1e-3", "22/7" exactly; nullopt if the text is not a number, or if it or its exponent is too
// large for a value of reasonable size.
std::optional<Rational> parse_rational(std::string_view text);

// Returns "3" or "-1/4".
std::string to_string(const Rational& r);

// Returns ln r of a positive r of any size.
double natural_logarithm(const Rational& r);

// Returns the exact root r^(1/n), if it is rational.
std::optional<Rational> exact_root(const Rational& r, unsigned long n);

// Returns base^exponent for an integer exponent; nullopt for 0^negative or a result of unreasonable size.
std::optional<Rational> exact_power(const Rational& base, long exponent);

}  // namespace anholon
