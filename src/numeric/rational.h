// Exact rational numbers and the decimal text that denotes them.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include <gmpxx.h>

namespace anholon {

using Rational = mpq_class;

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
