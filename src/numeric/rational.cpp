#include "numeric/rational.h"

#include <cctype>
#include <cmath>
#include <cstdlib>

namespace anholon {

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
  Rational r = scale >= 0 ? Rational(mantissa * power_of_ten(scale)) : Rational(mantissa, power_of_ten(-scale));
  r.canonicalize();
  return r;
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

double natural_logarithm(const Rational& r) {
  long p = 0, q = 0;
  const double num = mpz_get_d_2exp(&p, r.get_num_mpz_t()), den = mpz_get_d_2exp(&q, r.get_den_mpz_t());
  return std::log(num / den) + static_cast<double>(p - q) * 0.693147180559945309417;
}

std::optional<Rational> exact_root(const Rational& r, unsigned long n) {
  if (r < 0 && n % 2 == 0) return std::nullopt;
  mpz_class p, q;
  const bool exact =
      mpz_root(p.get_mpz_t(), r.get_num_mpz_t(), n) != 0 && mpz_root(q.get_mpz_t(), r.get_den_mpz_t(), n) != 0;
  if (!exact) return std::nullopt;
  return Rational(p, q);
}

std::optional<Rational> exact_power(const Rational& base, long exponent) {
  if (exponent == 0) return Rational(1);
  if (base == 0) return exponent > 0 ? std::optional<Rational>(0) : std::nullopt;
  const unsigned long n = static_cast<unsigned long>(exponent < 0 ? -exponent : exponent);
  const std::size_t bits = mpz_sizeinbase(base.get_num_mpz_t(), 2) + mpz_sizeinbase(base.get_den_mpz_t(), 2);
  if (n > 100000 || bits * n > 200000) return std::nullopt;
  mpz_class p, q;
  mpz_pow_ui(p.get_mpz_t(), base.get_num_mpz_t(), n);
  mpz_pow_ui(q.get_mpz_t(), base.get_den_mpz_t(), n);
  Rational r = exponent > 0 ? Rational(p, q) : Rational(q, p);
  r.canonicalize();
  return r;
}

}  // namespace anholon
