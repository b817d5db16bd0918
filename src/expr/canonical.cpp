// The canonical constructors of sums and products.
#include <algorithm>

#include "base/assert.h"
#include "base/diagnostic.h"
#include "expr/expr.h"

namespace anholon {

namespace {

// A product of more factors is one factor of a larger product, so that derivatives of a deep chain of functions stay
// linear in size. Shorter products are flat and therefore canonical.
constexpr std::uint32_t kOpenedFactors = 64;
// A sum of more terms is one term of a larger sum: the position of link i of a long chain.
constexpr std::uint32_t kOpenedTerms = 32;

// A sum of more terms is computed through the partial sum it grew from.
constexpr std::size_t kShortWayFrom = 8;

// Returns the rational content of a sum, with the sign that makes its first coefficient positive.
Rational content(const Graph& g, NodeId id) {
  const std::span<const Term> terms = g.terms(id);
  const bool negative = g.rational(terms[0].weight) < 0;
  bool whole = true, unit = false;
  for (const Term& t : terms) {
    const Rational& c = g.rational(t.weight);
    whole = whole && c.is_integer();
    unit = unit || c == 1 || c == -1;
  }
  if (whole && unit) return negative ? -1 : 1;
  Rational common = 0;
  for (const Term& t : terms) common = gcd(common, g.rational(t.weight));
  return negative ? -common : common;
}

struct Part {
  NodeId node;
  Rational coefficient;
};

// The lists of a sum under construction, whose storage the next sum uses again.
struct SumLists {
  std::vector<Part> parts, merged;
  std::vector<Term> flat, view;
};

SumLists& cleared_sum_lists() {
  thread_local SumLists lists;
  lists.parts.clear(), lists.merged.clear(), lists.flat.clear(), lists.view.clear();
  return lists;
}

}  // namespace

Expr Graph::sum(std::span<const std::pair<Rational, Expr>> operands) {
  spend(operands.size());
  auto& [parts, merged, flat, view] = cleared_sum_lists();
  std::size_t most = 0;
  for (const auto& [factor, e] : operands) ANHOLON_ASSERT(e.graph == this);
  for (const auto& [factor, e] : operands)
    most += nodes_[e.id].kind == Kind::sum && nodes_[e.id].count <= kOpenedTerms ? nodes_[e.id].count : 1;
  parts.reserve(most);
  NodeId longest = zero_;  // the operand sum with the most terms, candidate for the chain
  Rational longest_factor;
  for (const auto& [factor, e] : operands) {
    if (factor == 0) continue;
    const Node& n = nodes_[e.id];
    if (n.kind == Kind::number) {
      parts.push_back({one_, factor * value(e.id)});
    } else if (n.kind == Kind::sum && n.count > kOpenedTerms) {
      parts.push_back({e.id, factor});
    } else if (n.kind == Kind::sum) {
      spend(n.count);
      for (const Term& t : terms(e.id)) parts.push_back({t.node, factor * rational(t.weight)});
      if (n.count > 1 && (longest == zero_ || n.count > nodes_[longest].count)) longest = e.id, longest_factor = factor;
    } else {
      parts.push_back({e.id, factor});
    }
  }
  std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.node < b.node; });
  for (Part& p : parts) {
    if (!merged.empty() && merged.back().node == p.node)
      merged.back().coefficient += p.coefficient;
    else
      merged.push_back(std::move(p));
  }
  std::erase_if(merged, [](const Part& p) { return p.coefficient == 0; });
  if (merged.empty()) return zero();
  if (merged.size() == 1) {
    if (merged[0].node == one_) return number(merged[0].coefficient);
    if (merged[0].coefficient == 1) return {this, merged[0].node};
  }
  for (const Part& p : merged) flat.push_back({rational_index(p.coefficient), p.node});

  if (longest != zero_ && flat.size() > kShortWayFrom) {
    // The chain is usable if the longest operand is kept whole: flat = factor * longest + rest.
    view.push_back({rational_index(longest_factor), longest});
    std::size_t matched = 0;
    const std::span<const Term> inner = terms(longest);
    for (const Part& p : merged) {
      if (matched < inner.size() && inner[matched].node == p.node) {
        if (longest_factor * rational(inner[matched].weight) != p.coefficient) break;
        ++matched;
      } else {
        view.push_back({rational_index(p.coefficient), p.node});
      }
    }
    if (matched != inner.size() || view.size() >= flat.size()) view.clear();
  }
  return {this, intern(Node{Kind::sum}, flat, view)};
}

Expr Graph::scaled(const Rational& factor, NodeId id) {
  const std::pair<Rational, Expr> one_term[] = {{factor, Expr{this, id}}};
  return sum(one_term);
}

// A product under construction: a number times powers of nodes.
class Graph::Product {
 public:
  explicit Product(Graph& g) : g_(g) {}

  // Opens the operands one level at a time: from c*x inside a product the factor c is taken, from a product its
  // factors. Returns false if the product is zero.
  bool open(std::span<const std::pair<Expr, Rational>> operands) {
    for (auto it = operands.rbegin(); it != operands.rend(); ++it) {
      ANHOLON_ASSERT(it->first.graph == &g_);
      pending_.push_back({it->first.id, it->second});
    }
    while (!pending_.empty()) {
      Power p = std::move(pending_.back());
      pending_.pop_back();
      if (p.exponent == 0) continue;
      const Node n = g_.nodes_[p.node];
      g_.spend(n.kind == Kind::sum ? 1 + n.count : 1);
      const bool integer = p.exponent.is_integer();
      if (n.kind == Kind::number) {
        if (!open_number(std::move(p), integer)) return false;
      } else if (n.kind == Kind::sum) {
        open_sum(std::move(p), n, integer);
      } else if (n.kind == Kind::product && n.count <= kOpenedFactors && (integer || n.count == 1)) {
        open_product(std::move(p), integer);
      } else {
        powers_.push_back(std::move(p));
      }
    }
    return true;
  }

  // Joins the exponents of equal nodes.
  void join() {
    std::stable_sort(powers_.begin(), powers_.end(), [](const Power& a, const Power& b) { return a.node < b.node; });
    std::vector<Power> joined;
    for (Power& p : powers_) {
      if (!joined.empty() && joined.back().node == p.node) {
        joined.back().exponent += p.exponent;
        has_joined_ = true;
      } else {
        joined.push_back(std::move(p));
      }
    }
    std::erase_if(joined, [](const Power& p) { return p.exponent == 0; });
    powers_ = std::move(joined);
  }

  Expr result() {
    // If exponents were joined, a number, negative sum or product may open: sqrt(2)*sqrt(2) = 2.
    if (has_joined_ && std::any_of(powers_.begin(), powers_.end(), [&](const Power& p) { return opens(p); })) {
      std::vector<std::pair<Expr, Rational>> factors;
      for (const Power& p : powers_) factors.push_back({Expr{&g_, p.node}, p.exponent});
      return g_.scaled(coefficient_, g_.product(factors).id);
    }
    if (powers_.empty()) return g_.number(coefficient_);
    NodeId id = powers_[0].node;
    if (powers_.size() > 1 || powers_[0].exponent != 1) {
      std::vector<Term> flat;
      for (const Power& p : powers_) flat.push_back({g_.rational_index(p.exponent), p.node});
      id = g_.intern(Node{Kind::product}, flat, {});
    }
    return coefficient_ == 1 ? Expr{&g_, id} : g_.scaled(coefficient_, id);
  }

 private:
  struct Power {
    NodeId node;
    Rational exponent;
  };

  // Returns false if the number is zero.
  bool open_number(Power p, bool integer) {
    const Rational& v = g_.value(p.node);
    if (v == 1) return true;
    if (v == 0) {
      if (p.exponent < 0) throw Failure(Span{}, "division by zero");
      return false;
    }
    std::optional<Rational> power;
    if (integer && p.exponent.fits_long()) {
      power = exact_power(v, p.exponent.to_long());
    } else if (p.exponent.fits_long() && v > 0) {  // a negative number has no fractional power, as in numbers
      if (auto root = exact_root(v, p.exponent.get_den().get_ui())) power = exact_power(*root, p.exponent.to_long());
    }
    if (power)
      coefficient_ *= *power;
    else if (!integer)
      take_whole_part(std::move(p));  // 2^(3/2) = 2 * 2^(1/2)
    else
      powers_.push_back(std::move(p));
    return true;
  }

  // A positive content is taken out of any power, a sign out of a whole power. A long sum is unchanged: the sum scaled
  // by its content would be one term, which returns the factor.
  void open_sum(Power p, const Node& n, bool integer) {
    const Rational c = n.count == 1             ? g_.rational(g_.terms_[n.first].weight)
                       : n.count > kOpenedTerms ? Rational(1)
                                                : content(g_, p.node);
    const Rational out = integer ? c : Rational(abs(c));
    const bool whole_out = integer && exact_power(c, p.exponent.to_long());
    if (out != 1 && (whole_out || !integer)) {
      pending_.push_back({g_.number(out).id, p.exponent});
      pending_.push_back({g_.scaled(1 / out, p.node).id, p.exponent});
    } else if (c < 0 && !integer) {
      take_whole_part(std::move(p));
    } else {
      powers_.push_back(std::move(p));
    }
  }

  // (x^r)^n = x^(rn) for integer n; (x^r)^s = x^(rs) only where x^r keeps the sign of x.
  void open_product(Power p, bool integer) {
    const std::span<const Term> inner = g_.terms(p.node);
    if (!integer && g_.rational(inner[0].weight).is_integer()) {
      powers_.push_back(std::move(p));
      return;
    }
    for (const Term& t : inner) pending_.push_back({t.node, g_.rational(t.weight) * p.exponent});
  }

  // x^(n + s) = x^n x^s with 0 < s < 1.
  void take_whole_part(Power p) {
    const Rational whole = floor(p.exponent);
    if (whole == 0) {
      powers_.push_back(std::move(p));
      return;
    }
    pending_.push_back({p.node, whole});
    powers_.push_back({p.node, p.exponent - whole});
  }

  bool opens(const Power& p) const {
    const Node& n = g_.nodes_[p.node];
    const bool integer = p.exponent.is_integer(), proper = p.exponent > 0 && p.exponent < 1;
    if (n.kind == Kind::number) return integer || !proper;
    if (n.kind == Kind::product) return integer && n.count <= kOpenedFactors;
    if (n.kind != Kind::sum) return false;
    const Rational c = n.count == 1 ? g_.rational(g_.terms_[n.first].weight) : content(g_, p.node);
    return c < 0 && (integer || !proper);
  }

  Graph& g_;
  Rational coefficient_ = 1;
  std::vector<Power> pending_, powers_;
  bool has_joined_ = false;
};

Expr Graph::product(std::span<const std::pair<Expr, Rational>> operands) {
  Product p(*this);
  if (!p.open(operands)) return zero();
  p.join();
  return p.result();
}

Expr sum(std::span<const Expr> terms) {
  ANHOLON_ASSERT(!terms.empty());
  std::vector<std::pair<Rational, Expr>> parts;
  for (Expr e : terms) parts.push_back({1, e});
  return terms[0].graph->sum(parts);
}

}  // namespace anholon
