#include "print/grouping.h"

#include <bit>
#include <optional>

#include "base/stop.h"
#include "expr/diff.h"
#include "expr/polynomial.h"

namespace anholon::arrangement {

namespace {

// Bounds on the effort for one expression. All are far above the size that a person reads.
constexpr std::size_t kFactoredTerms = 64;      // monomials of a polynomial that FLINT factors,
constexpr std::size_t kFactoredVariables = 12;  // its variables
constexpr unsigned long kFactoredDegree = 10;   // and its total degree
constexpr std::size_t kComparedTerms = 100;     // monomials that are compared in pairs
constexpr long kMostSteps = 2'000;              // sums that are put into groups
constexpr long kMostComparisons = 1'000'000;    // comparisons of a monomial with a factor of others
constexpr std::size_t kNestedBrackets =
    3;                                 // the cost of brackets around n levels of brackets: this times n^2 characters,
constexpr std::size_t kRepeated = 12;  // the cost of an acceleration in a second place
constexpr int kDeepest = 12;           // groups within groups

using Mask = std::vector<bool>;

// An expression with an estimate of its printed length, to which nested brackets, and an acceleration that occurs in
// two places of a sum, add.
struct Built {
  Expr e;
  std::size_t length;
  bool is_sum;
  std::size_t depth = 0;            // depth of brackets
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
    return {c * g_.product(factors), std::max<std::size_t>(1, number + symbols - (symbols > 0 ? 1 : 0)), false, 0,
            bits};
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
    return b.is_sum
               ? Built{b.e, b.length + 2 + kNestedBrackets * b.depth * b.depth, false, b.depth + 1, b.accelerations}
               : b;
  }

  Built total(const std::vector<Built>& parts) const {
    std::vector<Expr> es;
    Built t{g_.zero(), 0, parts.size() > 1 || parts[0].is_sum};
    for (const Built& b : parts) {
      es.push_back(b.e);
      t.length += b.length + (es.size() > 1 ? 3 : 0) +
                  kRepeated * static_cast<std::size_t>(std::popcount(t.accelerations & b.accelerations));
      t.depth = std::max(t.depth, b.depth);
      t.accelerations |= b.accelerations;
    }
    t.e = sum(es);
    return t;
  }

  // Returns the shortest arrangement that is found, as a sum or, with brackets, as a factor of a product. Groups are
  // nested at most kDeepest deep.
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
    // The factors are built one after the other: what is made first stands first in a product, and the steps are
    // counted in this order.
    const Built second = build(b, depth + 1, !one(a)), first = build(a, depth + 1, !one(b));
    return times(first, second);
  }

  // Takes out the common factor of all terms.
  std::optional<Built> in_front(const Sum& s, int depth) {
    Exponents front = s.begin()->first;
    for (const auto& [exponents, c] : s) front = common(std::move(front), exponents);
    Sum rest;
    for (const auto& [exponents, c] : s) rest.emplace(quotient(exponents, front), c);
    const Rational c = take_content(rest);
    if (trivial(front) && c.is_integer()) return std::nullopt;
    const Built other = build(rest, depth + 1, true);
    return times(monomial(front, c), other);
  }

  // Returns a product of irreducible factors; nullopt if there is only one.
  std::optional<Built> factored(const Sum& s, int depth) {
    if (s.size() > kFactoredTerms) return std::nullopt;
    // The polynomial is taken in the generators that occur.
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

  // Returns sum_k C_k (sum_j r_kj M_j): monomials M in the generators of the mask with the same coefficient C, up to a
  // number, form one group. `swapped`: M is in the generators outside the mask.
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
    // The groups are useless if each holds one term, or one holds all terms.
    if (groups.size() == s.size() || groups.begin()->second.size() == s.size()) return std::nullopt;
    std::vector<Built> parts;
    for (const auto& [coefficient, monomials] : groups) parts.push_back(product(coefficient, monomials, depth));
    return total(parts);
  }

  // Repeatedly takes out the common factor of several terms that saves most.
  std::optional<Built> greedy(const Sum& s, int depth) {
    if (s.size() > kComparedTerms) return std::nullopt;
    std::map<Sum, Sum> groups;  // the sum in brackets -> its factors
    Sum rest = s;
    while (rest.size() > 1 && comparisons_ < kMostComparisons) {
      std::map<Exponents, std::size_t> shared;  // factor -> number of terms that contain it
      for (auto i = rest.begin(); i != rest.end(); ++i, look_for_stop())
        for (auto j = std::next(i); j != rest.end(); ++j) {
          Exponents factor = common(i->first, j->first);
          if (!trivial(factor)) shared.emplace(std::move(factor), 0);
        }
      const Exponents* best = nullptr;
      std::pair<std::size_t, int> most{3, -1};  // a smaller saving does not pay for the brackets
      for (auto& [factor, count] : shared) {
        look_for_stop();
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

}  // namespace

Grouped grouped(const Written& w, const SymbolNames& names) {
  Grouping grouping(w, names);
  const Built top = grouping.arrange(w.numerator, !one(w.denominator)), bottom = grouping.arrange(w.denominator, true);
  return {top.e / bottom.e, top.length + bottom.length};
}

}  // namespace anholon::arrangement
