#include "modelfile/check/unify.h"

#include <algorithm>

namespace anholon {

static bool pure(const Dimension& d) {
  return std::all_of(d.begin(), d.end(), [](const Rational& r) { return r == 0; });
}

DimensionForm power(const DimensionForm& a, const Rational& exponent) {
  DimensionForm f;
  if (exponent == 0) return f;
  for (std::size_t k = 0; k < f.known.size(); ++k) f.known[k] = a.known[k] * exponent;
  for (const auto& [x, p] : a.unknowns) f.unknowns[x] = p * exponent;
  return f;
}

DimensionForm operator*(const DimensionForm& a, const DimensionForm& b) {
  DimensionForm f = a;
  for (std::size_t k = 0; k < f.known.size(); ++k) f.known[k] += b.known[k];
  for (const auto& [x, p] : b.unknowns) {
    Rational& sum = f.unknowns[x];
    sum += p;
    if (sum == 0) f.unknowns.erase(x);
  }
  return f;
}

DimensionForm operator/(const DimensionForm& a, const DimensionForm& b) { return a * power(b, -1); }

DimensionForm Dimensions::unknown(const std::string& name) {
  solution_.emplace_back();
  names_.push_back(name);
  DimensionForm f;
  f.unknowns[solution_.size() - 1] = 1;
  return f;
}

DimensionForm Dimensions::resolved(const DimensionForm& f) const {
  // The solution of an unknown contains only older unknowns: from the newest down, each is substituted once.
  DimensionForm out = f;
  for (;;) {
    const auto it = std::find_if(out.unknowns.rbegin(), out.unknowns.rend(),
                                 [&](const auto& u) { return solution_[u.first].has_value(); });
    if (it == out.unknowns.rend()) return out;
    const auto [x, p] = *it;
    out.unknowns.erase(x);
    out = out * power(*solution_[x], p);
  }
}

bool Dimensions::equate(const DimensionForm& a, const DimensionForm& b) {
  const DimensionForm gap = resolved(a / b);
  if (gap.unknowns.empty()) return pure(gap.known);
  const auto [x, p] = *gap.unknowns.rbegin();
  DimensionForm rest = gap;
  rest.unknowns.erase(x);
  solution_[x] = power(rest, Rational(-1 / p));
  return true;
}

std::optional<Dimension> Dimensions::known(const DimensionForm& f) const {
  const DimensionForm r = resolved(f);
  if (!r.unknowns.empty()) return std::nullopt;
  return r.known;
}

std::string Dimensions::text(const DimensionForm& f) const {
  const DimensionForm r = resolved(f);
  if (r.unknowns.empty()) return describe(r.known);
  std::string out = pure(r.known) ? "" : print(r.known);
  for (const auto& [x, p] : r.unknowns)
    out += (out.empty() ? "" : "*") + ("[" + (names_[x].empty() ? "?" : names_[x]) + "]") +
           (p == 1 ? "" : "^" + (p.is_integer() && p > 0 ? p.get_str() : "(" + p.get_str() + ")"));
  return "a quantity in " + out;
}

}  // namespace anholon
