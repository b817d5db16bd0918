#include "numeric/exact_text.h"

#include <cstdio>
#include <cstdlib>

namespace anholon {

template <>
std::string exact_text(const double& x) {
  char buffer[64];
  return std::string(buffer, static_cast<std::size_t>(std::snprintf(buffer, sizeof buffer, "%a", x)));
}

template <>
std::string exact_text(const long double& x) {
  char buffer[64];
  return std::string(buffer, static_cast<std::size_t>(std::snprintf(buffer, sizeof buffer, "%La", x)));
}

template <>
std::string exact_text(const Multi& x) {
  char* text = nullptr;
  mpfr_asprintf(&text, "%Ra", x.raw());
  std::string r(text);
  mpfr_free_str(text);
  return r;
}

template <>
std::string exact_text(const Quad& x) {
  mpfr_t v;
  mpfr_init2(v, kQuadBits);
  set_mpfr(v, x);
  char* text = nullptr;
  mpfr_asprintf(&text, "%Ra", v);
  std::string r(text);
  mpfr_free_str(text);
  mpfr_clear(v);
  return r;
}

template <>
std::optional<double> parse_exact(const std::string& text) {
  char* end = nullptr;
  const double x = std::strtod(text.c_str(), &end);
  return text.empty() || *end ? std::nullopt : std::optional<double>(x);
}

template <>
std::optional<long double> parse_exact(const std::string& text) {
  char* end = nullptr;
  const long double x = std::strtold(text.c_str(), &end);
  return text.empty() || *end ? std::nullopt : std::optional<long double>(x);
}

template <>
std::optional<Quad> parse_exact(const std::string& text) {
  char* end = nullptr;
  mpfr_t v;
  mpfr_init2(v, kQuadBits);
  mpfr_strtofr(v, text.c_str(), &end, 0, MPFR_RNDN);
  const Quad x = quad_of(v);
  mpfr_clear(v);
  return text.empty() || *end ? std::nullopt : std::optional<Quad>(x);
}

template <>
std::optional<Multi> parse_exact(const std::string& text) {
  char* end = nullptr;
  Multi x;
  mpfr_strtofr(x.raw(), text.c_str(), &end, 0, MPFR_RNDN);
  return text.empty() || *end ? std::nullopt : std::optional<Multi>(x);
}

}  // namespace anholon
