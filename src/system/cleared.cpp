#include "system/cleared.h"

#include <algorithm>

namespace anholon {

namespace {

// The products of powers of a sum, and the factor that multiplies all of them.
class Clearing {
 public:
  explicit Clearing(Expr e) : g_(*e.graph) {
    std::vector<Term> terms;
    if (g_.node(e.id).kind == Kind::sum)
      terms.assign(g_.terms(e.id).begin(), g_.terms(e.id).end());
    else
      add_term(e.id, Rational(1));
    for (const Term& t : terms) add_term(t.node, g_.rational(t.weight));
  }

  bool divides() const { return !divisors_.empty(); }

  Expr sum() {
    std::vector<Expr> terms;
    for (Factors& product : products_) {
      product.insert(product.end(), divisors_.begin(), divisors_.end());
      terms.push_back(g_.product(product));
    }
    return anholon::sum(terms);
  }

 private:
  using Factors = std::vector<std::pair<Expr, Rational>>;

  void add_term(NodeId id, const Rational& weight) {
    products_.push_back({{g_.number(weight), Rational(1)}});
    std::vector<Term> factors;
    if (g_.node(id).kind == Kind::product)
      factors.assign(g_.terms(id).begin(), g_.terms(id).end());
    else
      add_factor(products_.back(), id, Rational(1));
    for (const Term& f : factors) add_factor(products_.back(), f.node, g_.rational(f.weight));
  }

  void add_factor(Factors& product, NodeId id, const Rational& power) {
    const Node& n = g_.node(id);
    const Expr base{&g_, id};
    if (n.kind == Kind::function && static_cast<Function>(n.index) == Function::tan) {
      const Expr angle{&g_, g_.terms(id)[0].node}, sine = sin(angle), cosine = cos(angle);
      if (power > 0 ? divide_by(cosine, power) : divide_by(sine, -power)) {
        product.push_back({sine, power});
        product.push_back({cosine, -power});
        return;
      }
    }
    if (n.kind == Kind::sum && power > 0) {
      Clearing within(base);
      product.push_back({within.sum(), power});
      for (const auto& [divisor, times] : within.divisors_)
        product.push_back({divisor, -times * power}), divide_by(divisor, times * power);
      return;
    }
    product.push_back({base, power});
    if (power < 0) divide_by(base, -power);
  }

  // Returns false if the divisor stays.
  bool divide_by(Expr base, const Rational& power) {
    bool varies = false;
    for (NodeId id : symbols({&base, 1})) {
      const Node& n = g_.node(id);
      if (n.order > 0) return false;
      varies = varies || (n.kind != Kind::pi && n.kind != Kind::parameter);
    }
    if (!varies) return false;
    const auto known = std::find_if(divisors_.begin(), divisors_.end(), [&](const auto& d) { return d.first == base; });
    if (known == divisors_.end())
      divisors_.push_back({base, power});
    else
      known->second = std::max(known->second, power);
    return true;
  }

  Graph& g_;
  std::vector<Factors> products_;
  Factors divisors_;
};

}  // namespace

Expr cleared(Expr e) {
  Clearing c(e);
  return c.divides() ? c.sum() : e;
}

}  // namespace anholon
