#include "expr/arrange.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <map>
#include <optional>

#include "expr/diff.h"
#include "expr/polynomial.h"

namespace anholon {

namespace {

// Bounds on the effort for one expression. All are far above what a person reads.
constexpr long kMostProducts = 300'000;        // products of terms in one normal form
constexpr std::size_t kArrangedTerms = 800;    // monomials that are grouped at all
constexpr std::size_t kFactoredTerms = 64;     // monomials of a polynomial that FLINT factors,
constexpr std::size_t kFactoredVariables = 12;  // its variables
constexpr unsigned long kFactoredDegree = 10;   // and its total degree
constexpr std::size_t kComparedTerms = 100;    // monomials that are compared in pairs
constexpr long kMostSteps = 2'000;             // sums that are put into groups
constexpr long kMostComparisons = 1'000'000;   // of a monomial with a factor of others
constexpr std::size_t kNestedBrackets = 3;      // what brackets around n levels of brackets cost: this times n^2 characters,
constexpr std::size_t kRepeated = 12;           // and an acceleration in a second place
constexpr int kDeepest = 12;                   // groups within groups

using Exponents = std::vector<unsigned long>;
using Mask = std::vector<bool>;
// Monomials by their exponents: equal sums are equal maps.
using Sum = std::map<Exponents, Rational, std::greater<>>;

Sum as_sum(const Monomials& terms) {
  Sum s;
  for (const Monomial& m : terms) s[m.exponents] += m.coefficient;
  std::erase_if(s, [](const auto& term) { return term.second == 0; });
  return s;
}

void add(Sum& s, const Exponents& exponents, const Rational& c) {
  const auto it = s.try_emplace(exponents).first;
  it->second += c;
  if (it->second == 0) s.erase(it);
}

bool divides(const Exponents& divisor, const Exponents& e) {
  for (std::size_t k = 0; k < e.size(); ++k)
    if (divisor[k] > e[k]) return false;
  return true;
}

Exponents quotient(Exponents e, const Exponents& divisor) {
  for (std::size_t k = 0; k < e.size(); ++k) e[k] -= divisor[k];
  return e;
}

Exponents common(Exponents a, const Exponents& b) {
  for (std::size_t k = 0; k < a.size(); ++k) a[k] = std::min(a[k], b[k]);
  return a;
}

bool trivial(const Exponents& e) {
  return std::all_of(e.begin(), e.end(), [](unsigned long n) { return n == 0; });
}

bool one(const Sum& s) { return s.size() == 1 && trivial(s.begin()->first) && s.begin()->second == 1; }

// The rational content with the sign of the first coefficient; s is divided by it.
Rational take_content(Sum& s) {
  mpz_class num = 0, den = 1;
  for (const auto& [exponents, c] : s) {
    num = gcd(num, c.get_num());
    den = lcm(den, c.get_den());
  }
  Rational content(num, den);
  content.canonicalize();
  if (s.begin()->second < 0) content = -content;
  for (auto& [exponents, c] : s) c /= content;
  return content;
}

struct Angle {
  std::size_t sine, cosine;
  Expr value;
};

// A sum of monomials with what its generators stand for: grows sines and cosines of sums of angles.
struct Written {
  std::vector<Expr> generators;
  std::vector<Angle> angles;
  Sum numerator, denominator;
};

// r X - r X c^2 = r X s^2: one term for two, as long as there are such pairs.
void shorten_squares(Sum& s, std::size_t kept, std::size_t other) {
  for (bool found = true; found;) {
    found = false;
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

// All even powers of one generator in terms of the other: s^2 = 1 - c^2.
Sum without_square(const Sum& s, std::size_t gone, std::size_t other) {
  Sum done, pending = s;
  while (!pending.empty()) {
    auto node = pending.extract(pending.begin());
    Exponents e = node.key();
    if (e[gone] < 2) {
      add(done, e, node.mapped());
      continue;
    }
    e[gone] -= 2;
    add(pending, e, node.mapped());
    e[other] += 2;
    add(pending, e, -node.mapped());
  }
  return done;
}

// For each angle the shorter of three: squares of the sine gone, of the cosine gone, or as it is; pairs
// that make one square of the other are joined.
void choose_squares(Sum& s, const std::vector<Angle>& angles) {
  for (const Angle& a : angles) {
    if (std::none_of(s.begin(), s.end(), [&](const auto& term) { return term.first[a.sine] > 1 || term.first[a.cosine] > 1; })) continue;
    Sum sine_gone = without_square(s, a.sine, a.cosine), cosine_gone = without_square(s, a.cosine, a.sine);
    shorten_squares(sine_gone, a.cosine, a.sine);
    shorten_squares(cosine_gone, a.sine, a.cosine);
    Sum& best = cosine_gone.size() < sine_gone.size() ? cosine_gone : sine_gone;
    if (best.size() <= s.size()) s = std::move(best);
  }
}

// cos a cos b + sin a sin b = cos(a - b) and its three sisters, for pairs of terms with equal cofactors.
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
  // r X u v + r' X y z with r' = r or -r.
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
    if (g.node(f.id).kind == Kind::sum && g.terms(f.id).size() == 1 && g.rational(g.terms(f.id)[0].weight) == -1) f = -f, sign = -1;
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

// An expression with an estimate of its length in print, to which brackets within brackets add, and the
// same acceleration in two places of a sum.
struct Built {
  Expr e;
  std::size_t length;
  bool is_sum;
  std::size_t depth = 0;            // of brackets
  std::uint64_t accelerations = 0;  // the first 64 that occur, one bit each
};

// Puts sums of monomials into groups.
class Grouping {
 public:
  Grouping(const Written& w, const SymbolNames& names) : w_(w), g_(*w.generators[0].graph) {
    const std::vector<std::string> texts = print(w.generators, names, Format::text);
    for (std::size_t k = 0; k < texts.size(); ++k) {
      const Expr e = w.generators[k];
      length_.push_back(texts[k].size());
      order_.push_back(jet_order(e));
      bool multiplier = false, constant = true;
      for (NodeId id : symbols({&e, 1})) {
        const Kind kind = g_.node(id).kind;
        multiplier |= kind == Kind::multiplier;
        constant &= kind == Kind::parameter || kind == Kind::mass || kind == Kind::pi;
      }
      moving_.push_back(!constant);
      accelerations_.push_back(order_.back() >= 2 || multiplier);
      velocities_.push_back(order_.back() >= 1 || multiplier);
      const bool leading = g_.node(e.id).kind == Kind::jet && order_.back() >= 2 && leading_ < 64;
      bit_.push_back(leading ? std::uint64_t{1} << leading_++ : 0);
    }
  }

  Built arrange(const Sum& s, bool factor) { return s.empty() ? Built{g_.zero(), 1, false} : build(s, 0, factor); }

 private:
  std::size_t length(const Exponents& e) const {
    std::size_t n = 0;
    for (std::size_t k = 0; k < e.size(); ++k)
      if (e[k] > 0) n += length_[k] + (e[k] > 1 ? 3 : 1);
    return n;
  }

  Built monomial(const Exponents& exponents, const Rational& c) const {
    std::vector<std::pair<Expr, Rational>> factors;
    for (std::size_t k = 0; k < exponents.size(); ++k)
      if (exponents[k] > 0) factors.push_back({w_.generators[k], Rational(exponents[k])});
    const std::size_t number = abs(c) == 1 ? 0 : c.get_str().size() + 1, symbols = length(exponents);
    std::uint64_t bits = 0;
    for (std::size_t k = 0; k < exponents.size(); ++k)
      if (exponents[k] > 0) bits |= bit_[k];
    return {c * g_.product(factors), std::max<std::size_t>(1, number + symbols - (symbols > 0 ? 1 : 0)), false, 0, bits};
  }

  Built flat(const Sum& s) const {
    std::vector<Built> parts;
    for (const auto& [exponents, c] : s) parts.push_back(monomial(exponents, c));
    return total(parts);
  }

  Built times(const Built& a, const Built& b) const {
    if (is_number(a.e) && number_value(a.e) == 1) return b;
    if (is_number(b.e) && number_value(b.e) == 1) return a;
    const Built c = bracketed(a), d = bracketed(b);
    return {a.e * b.e, c.length + d.length + 1, false, std::max(c.depth, d.depth), c.accelerations | d.accelerations};
  }

  Built bracketed(const Built& b) const {
    return b.is_sum ? Built{b.e, b.length + 2 + kNestedBrackets * b.depth * b.depth, false, b.depth + 1, b.accelerations} : b;
  }

  Built total(const std::vector<Built>& parts) const {
    std::vector<Expr> es;
    Built t{g_.zero(), 0, parts.size() > 1 || parts[0].is_sum};
    for (const Built& b : parts) {
      es.push_back(b.e);
      t.length += b.length + (es.size() > 1 ? 3 : 0) + kRepeated * static_cast<std::size_t>(std::popcount(t.accelerations & b.accelerations));
      t.depth = std::max(t.depth, b.depth);
      t.accelerations |= b.accelerations;
    }
    t.e = sum(es);
    return t;
  }

  // The shortest arrangement that is found, alone or as a factor of a product, where a sum needs brackets.
  // Groups lie within groups at most kDeepest times.
  Built build(const Sum& s, int depth, bool factor) {
    if (s.size() == 1) return monomial(s.begin()->first, s.begin()->second);
    if (depth > kDeepest || ++steps_ > kMostSteps) return flat(s);
    std::map<Sum, Built>& built = factor ? built_factors_ : built_sums_;
    const auto known = built.find(s);
    if (known != built.end()) return known->second;

    Built best = flat(s);
    const auto consider = [&](const std::optional<Built>& b) {
      const auto cost = [&](const Built& x) { return (factor ? bracketed(x) : x).length; };
      if (b && (cost(*b) < cost(best) || (factor && best.is_sum && !b->is_sum && cost(*b) == cost(best)))) best = *b;
    };
    consider(in_front(s, depth));
    consider(factored(s, depth));
    for (const Mask* mask : {&accelerations_, &velocities_, &moving_})
      for (bool swapped : {false, true}) consider(gathered(s, *mask, swapped, depth));
    consider(greedy(s, depth));
    built.emplace(s, best);
    return best;
  }

  Built product(const Sum& a, const Sum& b, int depth) {
    return times(build(a, depth + 1, !one(b)), build(b, depth + 1, !one(a)));
  }

  // The common factor of all terms.
  std::optional<Built> in_front(const Sum& s, int depth) {
    Exponents front = s.begin()->first;
    for (const auto& [exponents, c] : s) front = common(std::move(front), exponents);
    Sum rest;
    for (const auto& [exponents, c] : s) rest.emplace(quotient(exponents, front), c);
    const Rational c = take_content(rest);
    if (trivial(front) && c.get_den() == 1) return std::nullopt;
    return times(monomial(front, c), build(rest, depth + 1, true));
  }

  // Products of irreducible factors; nothing if there is one only.
  std::optional<Built> factored(const Sum& s, int depth) {
    if (s.size() > kFactoredTerms) return std::nullopt;
    // In the generators that occur.
    std::vector<std::size_t> used;
    for (std::size_t k = 0; k < w_.generators.size(); ++k)
      if (std::any_of(s.begin(), s.end(), [&](const auto& term) { return term.first[k] > 0; })) used.push_back(k);
    if (used.size() > kFactoredVariables) return std::nullopt;
    Monomials terms;
    for (const auto& [exponents, c] : s) {
      Monomial m{c, {}};
      unsigned long degree = 0;
      for (std::size_t k : used) m.exponents.push_back(exponents[k]), degree += exponents[k];
      if (degree > kFactoredDegree) return std::nullopt;
      terms.push_back(std::move(m));
    }
    const Ring ring(static_cast<long>(used.size()));
    const auto factors = Poly::of(ring, terms).factors();
    if (factors.empty() || (factors.size() == 1 && factors[0].second == 1)) return std::nullopt;
    Rational leading = s.begin()->second;
    Built product{g_.one(), 1, false};
    for (const auto& [base, exponent] : factors) {
      Sum factor;
      for (const Monomial& m : base.terms()) {
        Exponents e(w_.generators.size());
        for (std::size_t i = 0; i < used.size(); ++i) e[used[i]] = m.exponents[i];
        factor.emplace(std::move(e), m.coefficient);
      }
      for (unsigned long i = 0; i < exponent; ++i) leading /= factor.begin()->second;
      Built b = build(factor, depth + 1, true);
      if (exponent > 1) {
        b = bracketed(b);
        b.length += 2;
        b.e = pow(b.e, static_cast<int>(exponent));
      }
      product = times(product, b);
    }
    product.e = leading * product.e;
    if (abs(leading) != 1) product.length += leading.get_str().size() + 1;
    return product;
  }

  // sum_k C_k (sum_j r_kj M_j): the monomials M in the generators of the mask that have the same
  // coefficient C up to a number stand together. `swapped`: in the generators outside of it.
  std::optional<Built> gathered(const Sum& s, const Mask& mask, bool swapped, int depth) {
    std::map<Exponents, Sum, std::greater<>> coefficients;
    for (const auto& [exponents, c] : s) {
      Exponents in = exponents, out = exponents;
      for (std::size_t k = 0; k < in.size(); ++k) (mask[k] != swapped ? out : in)[k] = 0;
      coefficients[in].emplace(std::move(out), c);
    }
    if (coefficients.size() == 1) return std::nullopt;
    std::map<Sum, Sum> groups;
    for (auto& [in, coefficient] : coefficients) {
      const Rational c = take_content(coefficient);
      groups[coefficient].emplace(in, c);
    }
    // Each term alone, or all together as they were.
    if (groups.size() == s.size() || groups.begin()->second.size() == s.size()) return std::nullopt;
    std::vector<Built> parts;
    for (const auto& [coefficient, monomials] : groups) parts.push_back(product(coefficient, monomials, depth));
    return total(parts);
  }

  // Takes out the common factor of several terms that saves most, again and again.
  std::optional<Built> greedy(const Sum& s, int depth) {
    if (s.size() > kComparedTerms) return std::nullopt;
    std::map<Sum, Sum> groups;  // what is in brackets -> its factors
    Sum rest = s;
    while (rest.size() > 1 && comparisons_ < kMostComparisons) {
      std::map<Exponents, std::size_t> shared;  // factor -> terms that hold it
      for (auto i = rest.begin(); i != rest.end(); ++i)
        for (auto j = std::next(i); j != rest.end(); ++j) {
          Exponents factor = common(i->first, j->first);
          if (!trivial(factor)) shared.emplace(std::move(factor), 0);
        }
      const Exponents* best = nullptr;
      std::pair<std::size_t, int> most{3, -1};  // less does not pay for the brackets
      for (auto& [factor, count] : shared) {
        for (const auto& [exponents, c] : rest) count += divides(factor, exponents);
        int order = -1;
        for (std::size_t k = 0; k < factor.size(); ++k)
          if (factor[k] > 0) order = std::max(order, order_[k]);
        const std::pair<std::size_t, int> saved{(count - 1) * length(factor), order};
        if (saved > most) most = saved, best = &factor;
      }
      comparisons_ += static_cast<long>(shared.size() * rest.size());
      if (!best) break;
      Sum inner;
      for (auto it = rest.begin(); it != rest.end();) {
        if (!divides(*best, it->first)) {
          ++it;
          continue;
        }
        inner.emplace(quotient(it->first, *best), it->second);
        it = rest.erase(it);
      }
      const Rational c = take_content(inner);
      add(groups[inner], *best, c);
    }
    if (groups.empty()) return std::nullopt;
    std::vector<Built> parts;
    for (const auto& [inner, factors] : groups)
      if (!factors.empty()) parts.push_back(product(factors, inner, depth));
    for (const auto& [exponents, c] : rest) parts.push_back(monomial(exponents, c));
    return total(parts);
  }

  const Written& w_;
  Graph& g_;
  std::vector<std::size_t> length_;
  std::vector<int> order_;
  std::vector<std::uint64_t> bit_;
  int leading_ = 0;
  Mask accelerations_, velocities_, moving_;
  std::map<Sum, Built> built_sums_, built_factors_;
  long steps_ = 0, comparisons_ = 0;
};

// What of an expression can be left whole or not.
struct Features {
  bool sums_of_angles = false, fractions = false, names = false;
};

Features features(Expr e, const SymbolNames& names) {
  const Graph& g = *e.graph;
  Features f;
  for (NodeId id : reachable({&e, 1})) {
    const Node& n = g.node(id);
    f.names |= names.defined.count(id) > 0;
    if (n.kind == Kind::product)
      for (const Term& t : g.terms(id)) f.fractions |= g.rational(t.weight) < 0;
    if (n.kind == Kind::function) {
      const Function function = static_cast<Function>(n.index);
      f.sums_of_angles |= function == Function::tan ||
                          ((function == Function::sin || function == Function::cos) && g.node(g.terms(id)[0].node).kind == Kind::sum);
    }
  }
  return f;
}

}  // namespace

Expr arranged(Expr e, const SymbolNames& names) {
  const Graph& g = *e.graph;
  const Kind kind = g.node(e.id).kind;
  if (kind != Kind::sum && kind != Kind::product) return e;
  const auto length = [&](Expr x) {
    const std::string text = print(x, names, Format::text);
    return text.find("…") == std::string::npos ? text.size() : kLongestPrint;  // cut: as long as can be
  };
  Expr best = e;
  std::size_t shortest = length(e);
  const std::optional<NormalForm> written_out = normal_form(e, {}, kMostWork);
  if (written_out)
    if (const std::optional<Expr> full = expression(*written_out))  // `expanded(e)`
      if (const std::size_t n = length(*full); n <= shortest) best = *full, shortest = n;

  std::vector<Written> seen;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  const Features has = features(e, names);
  for (bool angles : {false, true})
    for (bool fractions : {false, true})
      for (bool keep_names : {false, true}) {
        if ((angles && !has.sums_of_angles) || (fractions && !has.fractions) || (keep_names && !has.names)) continue;
        const Whole whole{angles, fractions, keep_names ? &names.defined : nullptr};
        const std::optional<NormalForm> form = angles || fractions || keep_names ? normal_form(e, whole, kMostProducts) : written_out;
        if (!form || form->numerator.size() + form->denominator.size() > kArrangedTerms) continue;
        Written w{form->generators, {}, as_sum(form->numerator), as_sum(form->denominator)};
        const auto same = [&](const Written& o) { return o.generators == w.generators && o.numerator == w.numerator && o.denominator == w.denominator; };
        if (std::any_of(seen.begin(), seen.end(), same)) continue;
        seen.push_back(w);
        for (const auto& [s, c] : form->angles) {
          const Expr sine = form->generators[s], cosine = form->generators[c];  // numbers for multiples of pi
          if (g.node(sine.id).kind == Kind::function && g.node(cosine.id).kind == Kind::function)
            w.angles.push_back({s, c, {e.graph, g.terms(sine.id)[0].node}});
        }
        for (Sum* part : {&w.numerator, &w.denominator}) {
          choose_squares(*part, w.angles);
          SumsOfAngles(w, *part).run();
        }
        Grouping grouping(w, names);
        const Built top = grouping.arrange(w.numerator, !one(w.denominator)), bottom = grouping.arrange(w.denominator, true);
        const std::size_t cost = top.length + bottom.length;
        const Expr x = top.e / bottom.e;
        if (cost < least && length(x) <= shortest) best = x, least = cost;
      }
  return best;
}

}  // namespace anholon
