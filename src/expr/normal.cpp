#include "expr/normal.h"

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include "expr/diff.h"
#include "expr/polynomial.h"
#include "expr/refute.h"

namespace anholon {

namespace {

// Largest multiple of an angle that is expanded into powers of its sine and cosine.
constexpr long kLargestMultiple = 40;
constexpr std::size_t kPrintedTerms = 2000;

struct Fraction {
  Poly num, den;
};

// An angle x = sum_i c_i a_i as whole multiples of the independent angles a_i / q_i.
using Angle = std::vector<std::pair<NodeId, Rational>>;

class Normalizer {
 public:
  // `split_given`: also expands the sine of a sum that depends on t and parameters only (a proof needs it, a reader
  // does not).
  Normalizer(Expr root, bool split_given, const Whole& whole = {}, long most_work = kMostWork)
      : g_(*root.graph), root_(root), whole_(whole), split_given_(split_given) {
    find_nodes();
    collect();
    ring_ = std::make_unique<Ring>(std::max<long>(1, generators_), most_work);
    relations_ = std::make_unique<Relations>(*ring_);
  }

  bool zero() {
    for (NodeId id : ids_) fractions_.emplace(id, fraction(id));
    return fractions_.at(root_.id).num.zero();
  }

  Expr expand() {
    if (zero()) return g_.zero();
    const std::optional<Expr> e = expression(lowest());
    if (!e) throw TooLarge{};
    return *e;
  }

  NormalForm form() {
    zero();
    return lowest();
  }

 private:
  static constexpr long kDividedTerms = 300;  // longer fractions are not brought to lowest terms

  NormalForm lowest() {
    const Fraction& f = fractions_.at(root_.id);
    NormalForm out;
    out.generators = meanings();
    for (const auto& [node, k] : sine_)
      out.angles.push_back({static_cast<std::size_t>(k), static_cast<std::size_t>(cosine_.at(node))});
    if (f.den.one() || f.num.length() > kDividedTerms || f.den.length() > kDividedTerms) {
      out.numerator = printed(f.num);
      out.denominator = printed(f.den);
    } else {
      const Poly divisor = common(f.num, f.den);
      out.numerator = quotient(f.num, divisor).terms();
      out.denominator = quotient(f.den, divisor).terms();
    }
    return out;
  }

  static Monomials printed(const Poly& p) {
    if (static_cast<std::size_t>(p.length()) > kPrintedTerms) throw TooLarge{};
    return p.terms();
  }

  // Returns the expression of each generator.
  std::vector<Expr> meanings() {
    std::vector<std::pair<NodeId, unsigned long>> roots;
    std::vector<Expr> meaning(static_cast<std::size_t>(std::max<long>(1, generators_)), g_.one());
    const auto at = [&](long k) -> Expr& { return meaning[static_cast<std::size_t>(k)]; };
    for (const auto& [root, k] : root_generator_) {
      Rational e(1, root.second);
      at(k) = pow(Expr{&g_, root.first}, e);
      roots.push_back(root);
    }
    for (const auto& [root, k] : reciprocal_) at(k) = pow(Expr{&g_, root.first}, Rational(-1, root.second));
    for (const auto& [node, q] : denominator_) {
      const Expr angle = Rational(1, q) * Expr{&g_, node};
      at(sine_.at(node)) = sin(angle);
      at(cosine_.at(node)) = cos(angle);
    }
    for (const auto& [node, k] : generator_) at(k) = Expr{&g_, node};
    // The generator of x^(1/k) with x = n/d denotes d x^(1/k). Roots may contain earlier roots in d.
    std::sort(roots.begin(), roots.end());
    for (const auto& root : roots)
      at(root_generator_.at(root)) =
          at(root_generator_.at(root)) * expression(printed(fractions_.at(root.first).den), meaning);
    return meaning;
  }

  bool whole(NodeId id) const { return whole_.names && whole_.names->count(id) > 0; }

  // Collects the relevant nodes, ascending; nodes below a function or below a part that is not expanded are left out.
  void find_nodes() {
    std::vector<bool> seen(g_.size(), false);
    ids_.push_back(root_.id);
    seen[root_.id] = true;
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      const Node& n = g_.node(ids_[i]);
      if (n.kind == Kind::function || n.kind == Kind::atan2 || n.kind == Kind::select || n.kind == Kind::lookup ||
          whole(ids_[i]))
        continue;
      for (const Term& t : g_.summands(ids_[i]))
        if (!seen[t.node]) seen[t.node] = true, ids_.push_back(t.node);
    }
    std::sort(ids_.begin(), ids_.end());
  }

  bool trigonometric(const Node& n) const {
    if (n.kind != Kind::function) return false;
    const Function f = static_cast<Function>(n.index);
    return f == Function::sin || f == Function::cos || (f == Function::tan && !whole_.angles);
  }

  Angle angle(NodeId x) const {
    Angle a;
    const Expr e{&g_, x};
    if (g_.node(x).kind == Kind::sum && !whole_.angles && (split_given_ || jet_order(e) >= 0))
      for (const Term& t : g_.terms(x)) a.push_back({t.node, g_.rational(t.weight)});
    else
      a.push_back({x, 1});
    return a;
  }

  // Names the generators: reciprocals that are not expanded, roots (later ones, which may contain earlier ones, lead),
  // then sines, cosines, and all others.
  void collect() {
    std::vector<std::pair<NodeId, unsigned long>> roots, reciprocals;
    std::map<NodeId, mpz_class> angles;
    std::vector<NodeId> others;
    for (NodeId id : ids_) {
      const Node& n = g_.node(id);
      if (whole(id)) {
        others.push_back(id);
      } else if (trigonometric(n)) {
        for (const auto& [node, c] : angle(g_.terms(id)[0].node)) {
          mpz_class& q = angles.try_emplace(node, 1).first->second;
          q = lcm(q, c.get_den());
        }
      } else if (n.kind == Kind::product) {
        for (const Term& t : g_.terms(id)) {
          const Rational& e = g_.rational(t.weight);
          const mpz_class k = e.get_den();
          if (!k.fits_ulong_p()) throw TooLarge{};
          if (e < 0 && whole_.fractions)
            reciprocals.push_back({t.node, k.get_ui()});
          else if (k != 1)
            roots.push_back({t.node, k.get_ui()});
        }
      } else if (n.kind != Kind::number && n.kind != Kind::sum) {
        others.push_back(id);
      }
    }
    for (const auto& r : reciprocals)
      if (reciprocal_.try_emplace(r, generators_).second) ++generators_;
    std::sort(roots.begin(), roots.end());
    roots.erase(std::unique(roots.begin(), roots.end()), roots.end());
    for (auto it = roots.rbegin(); it != roots.rend(); ++it) root_generator_[*it] = generators_++;
    for (const auto& [node, q] : angles) {
      denominator_[node] = q;
      sine_[node] = generators_++;
    }
    for (const auto& [node, q] : angles) cosine_[node] = generators_++;
    for (NodeId id : others) generator_[id] = generators_++;
  }

  Poly constant(const Rational& r) const { return Poly::constant(*ring_, r); }
  Poly generator(long k) const { return Poly::generator(*ring_, k); }
  Poly reduce(const Poly& p) const { return relations_->remainder(p); }
  Fraction plain(Poly p) const { return {std::move(p), constant(1)}; }

  Fraction multiply(const Fraction& a, const Fraction& b) const {
    return {reduce(a.num * b.num), reduce(a.den * b.den)};
  }
  Fraction add(const Fraction& a, const Fraction& b) const {
    if (a.den.same(b.den)) return {a.num + b.num, a.den};
    return {reduce(a.num * b.den + b.num * a.den), reduce(a.den * b.den)};
  }

  Fraction power(const Fraction& x, long n) const {
    if (n < 0) {
      if (x.num.zero()) throw TooLarge{};  // 1/0: nothing is proved
      return power({x.den, x.num}, -n);
    }
    Fraction r = plain(constant(1));
    for (long k = 0; k < n; ++k) r = multiply(r, x);
    return r;
  }

  // Returns sin and cos of an angle as polynomials: (c + i s)^k for each independent angle.
  std::pair<Poly, Poly> sine_cosine(NodeId x) {
    Poly s = constant(0), c = constant(1);
    for (const auto& [node, coefficient] : angle(x)) {
      const Rational multiple = coefficient * Rational(denominator_.at(node));
      if (abs(multiple) > kLargestMultiple) throw TooLarge{};
      const long k = multiple.to_long();
      if (pythagoras_.insert(node).second) {
        const Poly a = generator(sine_.at(node)), b = generator(cosine_.at(node));
        relations_->add(a * a + b * b - constant(1));
      }
      const Poly s1 = k >= 0 ? generator(sine_.at(node)) : constant(-1) * generator(sine_.at(node));
      const Poly c1 = generator(cosine_.at(node));
      for (long i = 0; i < std::abs(k); ++i) {
        const Poly s2 = reduce(s * c1 + c * s1), c2 = reduce(c * c1 - s * s1);
        s = s2;
        c = c2;
      }
    }
    return {s, c};
  }

  // Returns x^(1/k) as a generator r with r^k = x; for x = n/d, r^k = n d^(k-1) and the root is r/d.
  Fraction root(NodeId node, unsigned long k) {
    const Poly r = generator(root_generator_.at({node, k}));
    const Fraction& x = fractions_.at(node);
    if (root_known_.insert({node, k}).second) {
      Poly power = constant(1), radicand = x.num;
      for (unsigned long i = 0; i < k; ++i) power = power * r;
      for (unsigned long i = 1; i < k; ++i) radicand = reduce(radicand * x.den);
      relations_->add_first(power - radicand);
    }
    return {r, x.den};
  }

  // Returns 1/x^(1/k) as a generator; if x is a monomial m, the product of both generators is 1.
  Fraction reciprocal(NodeId node, unsigned long k) {
    const Poly r = generator(reciprocal_.at({node, k}));
    const Fraction& x = fractions_.at(node);
    if (k == 1 && x.num.length() == 1 && x.den.one() && reciprocal_known_.insert(node).second)
      relations_->add(r * x.num - constant(1));
    return plain(r);
  }

  Fraction fraction(NodeId id) {
    const Node& n = g_.node(id);
    if (whole(id)) return plain(generator(generator_.at(id)));
    switch (n.kind) {
    case Kind::number:
      return plain(constant(g_.value(id)));
    case Kind::sum: {
      Fraction total = plain(constant(0));
      for (const Term& t : g_.summands(id)) {
        const Fraction& x = fractions_.at(t.node);
        total = add(total, {constant(g_.rational(t.weight)) * x.num, x.den});
      }
      return total;
    }
    case Kind::product: {
      Fraction total = plain(constant(1));
      for (const Term& t : g_.terms(id)) {
        const Rational& e = g_.rational(t.weight);
        if (abs(e) > 1000) throw TooLarge{};
        if (e < 0 && whole_.fractions) {
          total = multiply(total, power(reciprocal(t.node, e.get_den().get_ui()), -e.to_long()));
          continue;
        }
        const Fraction base = e.is_integer() ? fractions_.at(t.node) : root(t.node, e.get_den().get_ui());
        total = multiply(total, power(base, e.to_long()));
      }
      return total;
    }
    case Kind::function:
      if (trigonometric(n)) {
        const auto [s, c] = sine_cosine(g_.terms(id)[0].node);
        switch (static_cast<Function>(n.index)) {
        case Function::sin:
          return plain(s);
        case Function::cos:
          return plain(c);
        default:
          return {s, c};  // tan
        }
      }
      return plain(generator(generator_.at(id)));
    case Kind::pi:
    case Kind::time:
    case Kind::jet:
    case Kind::parameter:
    case Kind::mass:
    case Kind::multiplier:
    case Kind::given:
    case Kind::quasi:
    case Kind::atan2:
    case Kind::state:
    case Kind::control:
    case Kind::select:
    case Kind::lookup:
      return plain(generator(generator_.at(id)));
    }
    return plain(constant(0));
  }

  Graph& g_;
  Expr root_;
  Whole whole_;
  bool split_given_;
  std::vector<NodeId> ids_;
  long generators_ = 0;
  std::map<std::pair<NodeId, unsigned long>, long> reciprocal_, root_generator_;
  std::map<NodeId, mpz_class> denominator_;
  std::map<NodeId, long> sine_, cosine_, generator_;
  std::set<NodeId> pythagoras_, reciprocal_known_;
  std::set<std::pair<NodeId, unsigned long>> root_known_;
  std::unique_ptr<Ring> ring_;
  std::unique_ptr<Relations> relations_;
  std::map<NodeId, Fraction> fractions_;
};

}  // namespace

Expr expression(const Monomials& terms, const std::vector<Expr>& generators) {
  Graph& g = *generators[0].graph;
  std::vector<std::pair<Rational, Expr>> sum;
  for (const Monomial& m : terms) {
    std::vector<std::pair<Expr, Rational>> factors;
    for (std::size_t k = 0; k < m.exponents.size(); ++k)
      if (m.exponents[k] > 0) factors.push_back({generators[k], Rational(m.exponents[k])});
    sum.push_back({m.coefficient, g.product(factors)});
  }
  return g.sum(sum);
}

std::optional<Expr> expression(const NormalForm& f) {
  if (std::max(f.numerator.size(), f.denominator.size()) > kPrintedTerms) return std::nullopt;
  const Expr top = expression(f.numerator, f.generators), bottom = expression(f.denominator, f.generators);
  return is_number(bottom) && number_value(bottom) == 1 ? top : top / bottom;
}

bool proved_zero(Expr e) {
  if (is_zero(e)) return true;
  if (is_number(e) || refuted(e)) return false;
  try {
    return Normalizer(e, true).zero();
  } catch (const TooLarge&) {
    return false;
  }
}

std::optional<Expr> expanded(Expr e) { return expanded(e, kMostWork); }

std::optional<Expr> expanded(Expr e, long most_work) {
  try {
    return Normalizer(e, false, {}, most_work).expand();
  } catch (const TooLarge&) {
    return std::nullopt;
  }
}

std::optional<NormalForm> normal_form(Expr e, const Whole& whole, long most_work) {
  try {
    return Normalizer(e, false, whole, most_work).form();
  } catch (const TooLarge&) {
    return std::nullopt;
  }
}

}  // namespace anholon
