#include "numeric/number.h"

#include <algorithm>
#include <charconv>
#include <cstdio>

namespace anholon {

std::string number_text(double x, int digits) {
  if (!std::isfinite(x)) return std::isnan(x) ? "nan" : x > 0 ? "inf" : "-inf";
  char buffer[64];
  const auto r = digits > 0 ? std::to_chars(buffer, buffer + sizeof buffer, x, std::chars_format::general, digits)
                            : std::to_chars(buffer, buffer + sizeof buffer, x);
  return std::string(buffer, r.ptr);
}

std::string exact_text_if_short(const Rational& r) {
  constexpr std::size_t kLongest = 40;
  const std::string rounded = number_text(from_rational<double>(r));
  if (parse_rational(rounded) == r) return rounded;
  // An integer with a power of ten as its denominator is written with a point.
  Rational shifted = abs(r);
  std::size_t places = 0;
  for (; !shifted.is_integer() && places < kLongest; ++places) shifted *= 10;
  if (std::string digits = to_string(shifted); shifted.is_integer() && digits.size() <= kLongest) {
    if (places == 0) return (r < 0 ? "-" : "") + digits;
    if (digits.size() <= places) digits.insert(0, places + 1 - digits.size(), '0');
    return (r < 0 ? "-" : "") + digits.insert(digits.size() - places, ".");
  }
  const std::string fraction = to_string(r);
  return fraction.size() <= kLongest ? fraction : rounded;
}

std::string number_text(long double x, int digits) {
  if (!std::isfinite(x)) return std::isnan(x) ? "nan" : x > 0 ? "inf" : "-inf";
  char buffer[64];
  const auto r = digits > 0 ? std::to_chars(buffer, buffer + sizeof buffer, x, std::chars_format::general, digits)
                            : std::to_chars(buffer, buffer + sizeof buffer, x);
  return std::string(buffer, r.ptr);
}

std::string number_text(Quad x, int digits) {
  if (!is_finite(x)) return x != x ? "nan" : x > 0 ? "inf" : "-inf";
  mpfr_t v, back;
  mpfr_inits2(kQuadBits, v, back, static_cast<mpfr_ptr>(nullptr));
  set_mpfr(v, x);
  std::string s;
  // If no number of digits is given, the result has the fewest digits, at least kQuadDigits, that read back to x.
  for (int n = digits > 0 ? digits : kQuadDigits;; ++n) {
    char* text = nullptr;
    mpfr_asprintf(&text, "%.*Rg", n, v);
    s = text;
    mpfr_free_str(text);
    mpfr_set_str(back, s.c_str(), 10, MPFR_RNDN);
    if (digits > 0 || n >= kQuadTextDigits || mpfr_equal_p(back, v)) break;
  }
  mpfr_clears(v, back, static_cast<mpfr_ptr>(nullptr));
  return s;
}

std::string quad_text(Quad x, int digits) {
  return number_text(x, digits > 16 ? std::min(digits + 2, kQuadTextDigits) : 0);
}

std::string number_text(const Multi& x, int digits) {
  if (!x.finite()) return mpfr_nan_p(x.raw()) ? "nan" : mpfr_sgn(x.raw()) > 0 ? "inf" : "-inf";
  if (digits <= 0) digits = static_cast<int>(static_cast<double>(Multi::working_bits()) / 3.3219281);
  return x.to_string(digits);
}

}  // namespace anholon
