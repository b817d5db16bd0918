// Sums of monomials as maps, for the arrangement of expressions in print.
#pragma once
#include <algorithm>
#include <functional>
#include <map>
#include <vector>

#include "expr/expr.h"
#include "expr/monomial.h"

namespace anholon::arrangement {

using Exponents = std::vector<unsigned long>;
// Monomials by their exponents: equal sums are equal maps.
using Sum = std::map<Exponents, Rational, std::greater<>>;

inline Sum as_sum(const Monomials& terms) {
  Sum s;
  for (const Monomial& m : terms) s[m.exponents] += m.coefficient;
  std::erase_if(s, [](const auto& term) { return term.second == 0; });
  return s;
}

inline void add(Sum& s, const Exponents& exponents, const Rational& c) {
  const auto it = s.try_emplace(exponents).first;
  it->second += c;
  if (it->second == 0) s.erase(it);
}

inline bool divides(const Exponents& divisor, const Exponents& e) {
  for (std::size_t k = 0; k < e.size(); ++k)
    if (divisor[k] > e[k]) return false;
  return true;
}

inline Exponents quotient(Exponents e, const Exponents& divisor) {
  for (std::size_t k = 0; k < e.size(); ++k) e[k] -= divisor[k];
  return e;
}

inline Exponents common(Exponents a, const Exponents& b) {
  for (std::size_t k = 0; k < a.size(); ++k) a[k] = std::min(a[k], b[k]);
  return a;
}

inline bool trivial(const Exponents& e) {
  return std::all_of(e.begin(), e.end(), [](unsigned long n) { return n == 0; });
}

inline bool one(const Sum& s) { return s.size() == 1 && trivial(s.begin()->first) && s.begin()->second == 1; }

// Returns the rational content with the sign of the first coefficient; s is divided by it.
inline Rational take_content(Sum& s) {
  Rational content = 0;
  for (const auto& [exponents, c] : s) content = gcd(content, c);
  if (s.begin()->second < 0) content = -content;
  for (auto& [exponents, c] : s) c /= content;
  return content;
}

struct Angle {
  std::size_t sine, cosine;
  Expr value;
};

// A fraction of sums of monomials with the expressions of its generators; sines and cosines of sums of angles are added
// as generators.
struct Written {
  std::vector<Expr> generators;
  std::vector<Angle> angles;
  Sum numerator, denominator;
};

// These write squares of sines and cosines in the shorter way, and products as sines and cosines of sums of angles if
// that joins terms.
void choose_squares(Sum& s, const std::vector<Angle>& angles);
void join_angles(Written& w, Sum& s);

}  // namespace anholon::arrangement
