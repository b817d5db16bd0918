#include "numeric/rational.h"

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <ostream>

#include <flint/fmpq.h>
#include <mpfr.h>

namespace anholon {

namespace {

// The layout is FLINT's (numeric/flint_rational.h).
fmpq* flint(Rational& r) { return reinterpret_cast<fmpq*>(&r); }
const fmpq* flint(const Rational& r) { return reinterpret_cast<const fmpq*>(&r); }

mpz_class integer(const fmpz* n) {
  mpz_class out;
  fmpz_get_mpz(out.get_mpz_t(), n);
  return out;
}

}  // namespace

Rational::Rational(const mpz_class& n) { fmpz_set_mpz(&num_, n.get_mpz_t()); }

Rational::Rational(const mpz_class& p, const mpz_class& q) : Rational(p) {
  fmpz_set_mpz(&den_, q.get_mpz_t());
  fmpq_canonicalise(flint(*this));
}

Rational::Rational(double x) : Rational(from(mpq_class(x))) {}

Rational::Rational(const char* text) : Rational(from(mpq_class(text))) { fmpq_canonicalise(flint(*this)); }

Rational Rational::from(const mpq_class& r) {
  Rational out;
  fmpq_set_mpq(flint(out), r.get_mpq_t());
  return out;
}

void Rational::set_long(long n) { fmpz_set_si(&num_, n); }
void Rational::set_unsigned(unsigned long n) { fmpz_set_ui(&num_, n); }

void Rational::copy(const Rational& r) {
  fmpz_set(&num_, &r.num_);
  fmpz_set(&den_, &r.den_);
}

void Rational::clear() { fmpq_clear(flint(*this)); }

mpz_class Rational::get_num() const { return integer(&num_); }
mpz_class Rational::get_den() const { return integer(&den_); }
bool Rational::has_even_denominator() const { return fmpz_is_even(&den_) != 0; }
bool Rational::fits_long() const { return is_in_place() || (fmpz_fits_si(&num_) != 0 && fmpz_fits_si(&den_) != 0); }
std::uint64_t Rational::bits() const { return fmpz_bits(&num_) + fmpz_bits(&den_); }
std::size_t Rational::limbs() const { return static_cast<std::size_t>(fmpz_size(&num_) + fmpz_size(&den_)); }

std::pair<std::uint64_t, std::uint64_t> Rational::modulo(std::uint64_t p) const {
  return {fmpz_fdiv_ui(&num_, p), fmpz_fdiv_ui(&den_, p)};
}

mpq_class Rational::get_mpq() const {
  mpq_class out;
  fmpq_get_mpq(out.get_mpq_t(), flint(*this));
  return out;
}

double Rational::get_d() const {
  constexpr int kBits = std::numeric_limits<double>::digits;
  constexpr long kExact = 1L << kBits;
  if (den_ <= kExact && -kExact <= num_ && num_ <= kExact) return static_cast<double>(num_) / static_cast<double>(den_);
  mpfr_t v;
  mpfr_init2(v, kBits);
  mpfr_set_q(v, get_mpq().get_mpq_t(), MPFR_RNDN);
  const double nearest = mpfr_get_d(v, MPFR_RNDN);
  mpfr_clear(v);
  return nearest;
}

std::string Rational::get_str(int base) const {
  if (den_ == 1 && in_place(num_) && base == 10) return std::to_string(num_);
  return get_mpq().get_str(base);
}

std::uint64_t Rational::hash() const {
  // A comparison distinguishes two numbers with equal remainders.
  constexpr std::uint64_t kPrime = (std::uint64_t{1} << 61) - 1;
  const auto part = [](const long& n) {
    return in_place(n) ? static_cast<std::uint64_t>(n) : fmpz_fdiv_ui(&n, kPrime);
  };
  return part(num_) * 0x9e3779b97f4a7c15ULL + part(den_) * 0xc2b2ae3d27d4eb4fULL;
}

Rational& Rational::add(const Rational& r) {
  fmpq_add(flint(*this), flint(*this), flint(r));
  return *this;
}

Rational& Rational::subtract(const Rational& r) {
  fmpq_sub(flint(*this), flint(*this), flint(r));
  return *this;
}

Rational& Rational::multiply(const Rational& r) {
  fmpq_mul(flint(*this), flint(*this), flint(r));
  return *this;
}

Rational& Rational::divide(const Rational& r) {
  fmpq_div(flint(*this), flint(*this), flint(r));
  return *this;
}

Rational Rational::negated() const {
  Rational out;
  fmpq_neg(flint(out), flint(*this));
  return out;
}

int Rational::long_sign() const { return fmpz_sgn(&num_); }
int Rational::compare(const Rational& r) const { return fmpq_cmp(flint(*this), flint(r)); }

Rational gcd(const Rational& a, const Rational& b) {
  Rational out;
  fmpq_gcd(flint(out), flint(a), flint(b));
  return out;
}

Rational floor(const Rational& a) {
  Rational out;
  fmpz_fdiv_q(&out.num_, &a.num_, &a.den_);
  return out;
}

static constexpr long kLargestExponent = 5000;
static constexpr std::size_t kLongestText = 5000;

static mpz_class power_of_ten(long n) {
  mpz_class r;
  mpz_ui_pow_ui(r.get_mpz_t(), 10, static_cast<unsigned long>(n));
  return r;
}

static std::optional<Rational> parse_decimal(std::string_view text) {
  std::string digits;
  long scale = 0;
  std::size_t i = 0;
  bool negative = false, any = false;
  if (i < text.size() && (text[i] == '+' || text[i] == '-')) negative = text[i++] == '-';
  for (; i < text.size() && std::isdigit(static_cast<unsigned char>(text[i])); ++i, any = true) digits += text[i];
  if (i < text.size() && text[i] == '.')
    for (++i; i < text.size() && std::isdigit(static_cast<unsigned char>(text[i])); ++i, any = true) {
      digits += text[i];
      --scale;
    }
  if (!any) return std::nullopt;
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    const std::string exponent(text.substr(i + 1));
    if (exponent.find_first_not_of("+-0123456789") != std::string::npos) return std::nullopt;
    char* end = nullptr;
    const long e = std::strtol(exponent.c_str(), &end, 10);
    if (end == exponent.c_str() || *end != 0) return std::nullopt;
    if (e > kLargestExponent || e < -kLargestExponent) return std::nullopt;
    scale += e;
    i = text.size();
  }
  if (i != text.size()) return std::nullopt;
  mpz_class mantissa(digits, 10);
  if (negative) mantissa = -mantissa;
  return scale >= 0 ? Rational(mpz_class(mantissa * power_of_ten(scale))) : Rational(mantissa, power_of_ten(-scale));
}

std::optional<Rational> parse_rational(std::string_view text) {
  if (text.size() > kLongestText) return std::nullopt;
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return parse_decimal(text);
  const auto p = parse_decimal(text.substr(0, slash)), q = parse_decimal(text.substr(slash + 1));
  if (!p || !q || *q == 0) return std::nullopt;
  return Rational(*p / *q);
}

std::string to_string(const Rational& r) { return r.get_str(); }

std::ostream& operator<<(std::ostream& out, const Rational& r) { return out << r.get_str(); }

double natural_logarithm(const Rational& r) {
  long p = 0, q = 0;
  const mpz_class above = r.get_num(), below = r.get_den();
  const double num = mpz_get_d_2exp(&p, above.get_mpz_t()), den = mpz_get_d_2exp(&q, below.get_mpz_t());
  return std::log(num / den) + static_cast<double>(p - q) * 0.693147180559945309417;
}

std::optional<Rational> exact_root(const Rational& r, unsigned long n) {
  if (r < 0 && n % 2 == 0) return std::nullopt;
  mpz_class p, q;
  const bool exact = mpz_root(p.get_mpz_t(), r.get_num().get_mpz_t(), n) != 0 &&
                     mpz_root(q.get_mpz_t(), r.get_den().get_mpz_t(), n) != 0;
  if (!exact) return std::nullopt;
  return Rational(p, q);
}

std::optional<Rational> exact_power(const Rational& base, long exponent) {
  if (exponent == 0) return Rational(1);
  if (base == 0) return exponent > 0 ? std::optional<Rational>(0) : std::nullopt;
  const unsigned long n = exponent < 0 ? -static_cast<unsigned long>(exponent) : static_cast<unsigned long>(exponent);
  if (n > 100000 || base.bits() * n > 200000) return std::nullopt;
  Rational power;
  fmpq_pow_si(flint(power), flint(base), exponent);
  return power;
}

}  // namespace anholon
