// Sines and cosines in sums of monomials: applies sin^2 + cos^2 = 1 and the addition theorems backwards.
#include <algorithm>

#include "base/stop.h"
#include "expr/monomial_sums.h"

namespace anholon::arrangement {

namespace {

// Replaces r X - r X c^2 by r X s^2, one term for two, as long as there are such pairs.
void shorten_squares(Sum& s, std::size_t kept, std::size_t other) {
  for (bool found = true; found;) {
    found = false;
    look_for_stop();
    for (const auto& [exponents, c] : s) {
      Exponents squared = exponents;
      squared[kept] += 2;
      const auto partner = s.find(squared);
      if (partner == s.end() || partner->second != -c) continue;
      Exponents result = exponents;
      result[other] += 2;
      const Rational r = c;
      const Exponents first = exponents;
      add(s, first, -r);
      add(s, squared, r);
      add(s, result, r);
      found = true;
      break;
    }
  }
}

// Writes all even powers of one generator in terms of the other: s^2k = (1 - c^2)^k.
Sum without_square(const Sum& s, std::size_t gone, std::size_t other) {
  Sum result;
  for (const auto& [exponents, c] : s) {
    look_for_stop();
    const unsigned long k = exponents[gone] / 2;
    Exponents e = exponents;
    e[gone] -= 2 * k;
    Rational binomial = c;
    for (unsigned long i = 0; i <= k; ++i) {
      add(result, e, binomial);
      binomial *= Rational(-static_cast<long>(k - i));
      binomial /= Rational(static_cast<long>(i + 1));
      e[other] += 2;
    }
  }
  return result;
}

// Applies cos a cos b + sin a sin b = cos(a - b) and its three variants to pairs of terms with equal cofactors.
class SumsOfAngles {
 public:
  SumsOfAngles(Written& w, Sum& s) : w_(w), s_(s) {}

  void run() {
    const std::size_t n = w_.angles.size();
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j) {
        const Angle a = w_.angles[i], b = w_.angles[j];
        join(a.cosine, b.cosine, a.sine, b.sine, a, b, true);
        join(a.sine, b.cosine, a.cosine, b.sine, a, b, false);
      }
  }

 private:
  // Joins r X u v + r' X y z with r' = r or -r.
  void join(std::size_t u, std::size_t v, std::size_t y, std::size_t z, const Angle& a, const Angle& b, bool cosine) {
    std::vector<Exponents> candidates;
    for (const auto& [exponents, c] : s_)
      if (exponents[u] > 0 && exponents[v] > 0) candidates.push_back(exponents);
    for (Exponents first : candidates) {
      first.resize(w_.generators.size());
      const auto at = s_.find(first);
      if (at == s_.end()) continue;
      const Rational r = at->second;
      Exponents second = first;
      --second[u], --second[v];
      Exponents rest = second;
      ++second[y], ++second[z];
      const auto partner = s_.find(second);
      if (partner == s_.end() || abs(partner->second) != abs(r)) continue;
      const bool same = partner->second == r;
      // cos a cos b + sin a sin b = cos(a - b);  sin a cos b + cos a sin b = sin(a + b)
      const Expr angle = cosine == same ? a.value - b.value : a.value + b.value;
      const auto [k, sign] = generator(angle, cosine);
      rest.resize(w_.generators.size());
      first.resize(w_.generators.size());
      second.resize(w_.generators.size());
      ++rest[k];
      const Rational r2 = same ? r : Rational(-r);
      add(s_, first, -r);
      add(s_, second, -r2);
      add(s_, rest, sign * r);
    }
  }

  std::pair<std::size_t, int> generator(Expr angle, bool cosine) {
    Expr f = cosine ? cos(angle) : sin(angle);
    int sign = 1;
    const Graph& g = *f.graph;
    if (g.node(f.id).kind == Kind::sum && g.terms(f.id).size() == 1 && g.rational(g.terms(f.id)[0].weight) == -1)
      f = -f, sign = -1;
    const auto it = std::find(w_.generators.begin(), w_.generators.end(), f);
    if (it != w_.generators.end()) return {static_cast<std::size_t>(it - w_.generators.begin()), sign};
    w_.generators.push_back(f);
    for (Sum* s : {&w_.numerator, &w_.denominator}) {
      Sum wider;
      for (auto& [exponents, c] : *s) {
        Exponents e = exponents;
        e.push_back(0);
        wider.emplace(std::move(e), c);
      }
      *s = std::move(wider);
    }
    return {w_.generators.size() - 1, sign};
  }

  Written& w_;
  Sum& s_;
};

}  // namespace

// Chooses for each angle the shortest of three forms: without squares of the sine, without squares of the cosine, or
// unchanged; joins pairs of terms that make one square of the other function.
void choose_squares(Sum& s, const std::vector<Angle>& angles) {
  for (const Angle& a : angles) {
    if (std::none_of(s.begin(), s.end(),
                     [&](const auto& term) { return term.first[a.sine] > 1 || term.first[a.cosine] > 1; }))
      continue;
    Sum sine_gone = without_square(s, a.sine, a.cosine), cosine_gone = without_square(s, a.cosine, a.sine);
    shorten_squares(sine_gone, a.cosine, a.sine);
    shorten_squares(cosine_gone, a.sine, a.cosine);
    Sum& best = cosine_gone.size() < sine_gone.size() ? cosine_gone : sine_gone;
    if (best.size() <= s.size()) s = std::move(best);
  }
}

void join_angles(Written& w, Sum& s) { SumsOfAngles(w, s).run(); }

}  // namespace anholon::arrangement
