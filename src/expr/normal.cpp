#include "expr/normal.h"

#include <flint/fmpq_mpoly.h>

#include <algorithm>
#include <map>
#include <memory>
#include <vector>

#include "expr/diff.h"

namespace anholon {

namespace {

struct TooLarge {};

// Largest multiple of an angle that is expanded into powers of its sine and cosine.
constexpr long kLargestMultiple = 40;

// Coefficients of more bits than this end the test.
constexpr long kLargestCoefficient = 4000;
// Products of terms in one test.
constexpr long kMostWork = 10'000'000;

// Polynomials over Q in a fixed number of generators, lexicographic, earlier generators first.
class Ring {
 public:
  explicit Ring(long generators) { fmpq_mpoly_ctx_init(context_, generators, ORD_LEX); }
  ~Ring() { fmpq_mpoly_ctx_clear(context_); }
  Ring(const Ring&) = delete;
  Ring& operator=(const Ring&) = delete;
  const fmpq_mpoly_ctx_struct* context() const { return context_; }
  void spend(long work) const {
    if (work > kNormalTermLimit || (work_ += work) > kMostWork) throw TooLarge{};
  }

 private:
  fmpq_mpoly_ctx_t context_;
  mutable long work_ = 0;
};

class Poly {
 public:
  explicit Poly(const Ring& ring) : ring_(&ring) { fmpq_mpoly_init(p_, ring.context()); }
  Poly(const Poly& o) : ring_(o.ring_) {
    fmpq_mpoly_init(p_, ring_->context());
    fmpq_mpoly_set(p_, o.p_, ring_->context());
  }
  Poly& operator=(const Poly& o) { fmpq_mpoly_set(p_, o.p_, ring_->context()); return *this; }
  ~Poly() { fmpq_mpoly_clear(p_, ring_->context()); }
  static Poly constant(const Ring& ring, const Rational& r) {
    Poly p(ring);
    fmpq_t c;
    fmpq_init(c);
    fmpq_set_mpq(c, r.get_mpq_t());
    fmpq_mpoly_set_fmpq(p.p_, c, ring.context());
    fmpq_clear(c);
    return p;
  }
  static Poly generator(const Ring& ring, long k) {
    Poly p(ring);
    fmpq_mpoly_gen(p.p_, k, ring.context());
    return p;
  }
  bool zero() const { return fmpq_mpoly_is_zero(p_, ring_->context()) != 0; }
  bool one() const { return fmpq_mpoly_is_one(p_, ring_->context()) != 0; }
  bool same(const Poly& o) const { return fmpq_mpoly_equal(p_, o.p_, ring_->context()) != 0; }
  // Terms as (coefficient, exponents).
  std::vector<std::pair<Rational, std::vector<unsigned long>>> terms(long generators) const {
    std::vector<std::pair<Rational, std::vector<unsigned long>>> out;
    fmpq_t c;
    fmpq_init(c);
    for (long k = 0; k < length(); ++k) {
      fmpq_mpoly_get_term_coeff_fmpq(c, p_, k, ring_->context());
      Rational r;
      fmpq_get_mpq(r.get_mpq_t(), c);
      std::vector<unsigned long> exponents(static_cast<std::size_t>(generators));
      fmpq_mpoly_get_term_exp_ui(exponents.data(), p_, k, ring_->context());
      out.push_back({std::move(r), std::move(exponents)});
    }
    fmpq_clear(c);
    return out;
  }
  long length() const { return fmpq_mpoly_length(p_, ring_->context()); }
  friend Poly operator+(const Poly& a, const Poly& b) {
    Poly r(*a.ring_);
    fmpq_mpoly_add(r.p_, a.p_, b.p_, a.ring_->context());
    return r;
  }
  friend Poly operator-(const Poly& a, const Poly& b) {
    Poly r(*a.ring_);
    fmpq_mpoly_sub(r.p_, a.p_, b.p_, a.ring_->context());
    return r;
  }
  friend Poly operator*(const Poly& a, const Poly& b) {
    a.ring_->spend(a.length() * b.length());
    if (std::abs(fmpz_mpoly_max_bits(a.p_->zpoly)) > kLargestCoefficient) throw TooLarge{};
    Poly r(*a.ring_);
    fmpq_mpoly_mul(r.p_, a.p_, b.p_, a.ring_->context());
    return r;
  }
  // Divides both by their greatest common divisor, where it is found.
  static void cancel(Poly& a, Poly& b) {
    Poly d(*a.ring_), qa(*a.ring_), qb(*a.ring_);
    if (fmpq_mpoly_gcd(d.p_, a.p_, b.p_, a.ring_->context()) == 0 || d.one()) return;
    if (fmpq_mpoly_divides(qa.p_, a.p_, d.p_, a.ring_->context()) == 0) return;
    if (fmpq_mpoly_divides(qb.p_, b.p_, d.p_, a.ring_->context()) == 0) return;
    a = qa;
    b = qb;
  }
  // The remainder after division by all of `relations`.
  Poly reduced(const std::vector<Poly>& relations) const {
    if (relations.empty()) return *this;
    std::vector<Poly> quotients(relations.size(), Poly(*ring_));
    std::vector<fmpq_mpoly_struct*> q, d;
    for (std::size_t i = 0; i < relations.size(); ++i) {
      q.push_back(quotients[i].p_);
      d.push_back(const_cast<fmpq_mpoly_struct*>(relations[i].p_));
    }
    Poly r(*ring_);
    fmpq_mpoly_divrem_ideal(q.data(), r.p_, p_, d.data(), static_cast<slong>(d.size()), ring_->context());
    return r;
  }

 private:
  const Ring* ring_;
  fmpq_mpoly_t p_;
};

struct Fraction {
  Poly num, den;
};

// An angle x = sum_i c_i a_i as whole multiples of the independent angles a_i / q_i.
using Angle = std::vector<std::pair<NodeId, Rational>>;

class Normalizer {
 public:
  // `split_given`: also expand the sine of a sum that depends on t and parameters only (a proof needs
  // that, a reader does not).
  Normalizer(Expr root, bool split_given) : g_(*root.graph), root_(root), ids_(reachable({&root, 1})), split_given_(split_given) {
    collect();
    ring_ = std::make_unique<Ring>(std::max<long>(1, generators_));
  }

  bool zero() {
    for (NodeId id : ids_) fractions_.emplace(id, fraction(id));
    return fractions_.at(root_.id).num.zero();
  }

  Expr expand() {
    if (zero()) return g_.zero();
    Fraction f = fractions_.at(root_.id);
    if (!f.den.one()) Poly::cancel(f.num, f.den);
    const Expr top = expression(f.num);
    return f.den.one() ? top : top / expression(f.den);
  }

 private:
  static constexpr long kPrintedTerms = 2000;

  Expr expression(const Poly& p) {
    if (p.length() > kPrintedTerms) throw TooLarge{};
    std::vector<std::pair<NodeId, unsigned long>> roots;
    std::vector<Expr> meaning(static_cast<std::size_t>(std::max<long>(1, generators_)), g_.one());
    const auto at = [&](long k) -> Expr& { return meaning[static_cast<std::size_t>(k)]; };
    for (const auto& [root, k] : root_generator_) {
      Rational e(1, root.second);
      at(k) = pow(Expr{&g_, root.first}, e);
      roots.push_back(root);
    }
    for (const auto& [node, q] : denominator_) {
      const Expr angle = Rational(1, q) * Expr{&g_, node};
      at(sine_.at(node)) = sin(angle);
      at(cosine_.at(node)) = cos(angle);
    }
    for (const auto& [node, k] : generator_) at(k) = Expr{&g_, node};
    // The generator of x^(1/k) with x = n/d stands for d x^(1/k). Roots may hold earlier roots in d.
    std::sort(roots.begin(), roots.end());
    for (const auto& root : roots) at(root_generator_.at(root)) = at(root_generator_.at(root)) * monomials(fractions_.at(root.first).den, meaning);
    return monomials(p, meaning);
  }

  Expr monomials(const Poly& p, const std::vector<Expr>& meaning) {
    if (p.length() > kPrintedTerms) throw TooLarge{};
    std::vector<std::pair<Rational, Expr>> sum;
    for (const auto& [c, exponents] : p.terms(static_cast<long>(meaning.size()))) {
      std::vector<std::pair<Expr, Rational>> factors;
      for (std::size_t k = 0; k < exponents.size(); ++k)
        if (exponents[k] > 0) factors.push_back({meaning[k], Rational(exponents[k])});
      sum.push_back({c, g_.product(factors)});
    }
    return g_.sum(sum);
  }

  bool trigonometric(const Node& n) const {
    if (n.kind != Kind::function) return false;
    const Function f = static_cast<Function>(n.index);
    return f == Function::sin || f == Function::cos || f == Function::tan;
  }

  Angle angle(NodeId x) const {
    Angle a;
    const Expr e{&g_, x};
    if (g_.node(x).kind == Kind::sum && (split_given_ || jet_order(e) >= 0))
      for (const Term& t : g_.terms(x)) a.push_back({t.node, g_.rational(t.weight)});
    else
      a.push_back({x, 1});
    return a;
  }

  // Names the generators: roots first (later ones, which may contain earlier ones, leading), then
  // sines, cosines, and all else.
  void collect() {
    std::vector<std::pair<NodeId, unsigned long>> roots;
    std::map<NodeId, mpz_class> angles;
    std::vector<NodeId> others;
    for (NodeId id : ids_) {
      const Node& n = g_.node(id);
      if (trigonometric(n)) {
        for (const auto& [node, c] : angle(g_.terms(id)[0].node)) {
          mpz_class& q = angles.try_emplace(node, 1).first->second;
          q = lcm(q, c.get_den());
        }
      } else if (n.kind == Kind::product) {
        for (const Term& t : g_.terms(id)) {
          const mpz_class& k = g_.rational(t.weight).get_den();
          if (k == 1) continue;
          if (!k.fits_ulong_p()) throw TooLarge{};
          roots.push_back({t.node, k.get_ui()});
        }
      } else if (n.kind != Kind::number && n.kind != Kind::sum) {
        others.push_back(id);
      }
    }
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
  Poly reduce(const Poly& p) const { return p.reduced(relations_); }
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
      if (x.num.zero()) throw TooLarge{};  // 1/0: no statement
      return power({x.den, x.num}, -n);
    }
    Fraction r = plain(constant(1));
    for (long k = 0; k < n; ++k) r = multiply(r, x);
    return r;
  }

  // sin and cos of an angle as polynomials: (c + i s)^k for each independent angle.
  std::pair<Poly, Poly> sine_cosine(NodeId x) {
    Poly s = constant(0), c = constant(1);
    for (const auto& [node, coefficient] : angle(x)) {
      const Rational multiple = coefficient * Rational(denominator_.at(node));
      if (abs(multiple) > kLargestMultiple) throw TooLarge{};
      const long k = multiple.get_num().get_si();
      if (pythagoras_.insert({node, true}).second) {
        const Poly a = generator(sine_.at(node)), b = generator(cosine_.at(node));
        relations_.push_back(a * a + b * b - constant(1));
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

  // x^(1/k) as a generator r with r^k = x; for x = n/d, r^k = n d^(k-1) and the root is r/d.
  Fraction root(NodeId node, unsigned long k) {
    const Poly r = generator(root_generator_.at({node, k}));
    const Fraction& x = fractions_.at(node);
    if (root_known_.insert({{node, k}, true}).second) {
      Poly power = constant(1), radicand = x.num;
      for (unsigned long i = 0; i < k; ++i) power = power * r;
      for (unsigned long i = 1; i < k; ++i) radicand = reduce(radicand * x.den);
      relations_.insert(relations_.begin(), power - radicand);
    }
    return {r, x.den};
  }

  Fraction fraction(NodeId id) {
    const Node& n = g_.node(id);
    switch (n.kind) {
      case Kind::number: return plain(constant(g_.value(id)));
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
          const Fraction base = e.get_den() == 1 ? fractions_.at(t.node) : root(t.node, e.get_den().get_ui());
          total = multiply(total, power(base, e.get_num().get_si()));
        }
        return total;
      }
      case Kind::function:
        if (trigonometric(n)) {
          const auto [s, c] = sine_cosine(g_.terms(id)[0].node);
          switch (static_cast<Function>(n.index)) {
            case Function::sin: return plain(s);
            case Function::cos: return plain(c);
            default: return {s, c};  // tan
          }
        }
        return plain(generator(generator_.at(id)));
      case Kind::pi: case Kind::time: case Kind::jet: case Kind::parameter: case Kind::mass:
      case Kind::multiplier: case Kind::given: case Kind::quasi: case Kind::atan2:
        return plain(generator(generator_.at(id)));
    }
    return plain(constant(0));
  }

  Graph& g_;
  Expr root_;
  std::vector<NodeId> ids_;
  bool split_given_;
  long generators_ = 0;
  std::map<std::pair<NodeId, unsigned long>, long> root_generator_;
  std::map<NodeId, mpz_class> denominator_;
  std::map<NodeId, long> sine_, cosine_, generator_;
  std::map<NodeId, bool> pythagoras_;
  std::map<std::pair<NodeId, unsigned long>, bool> root_known_;
  std::unique_ptr<Ring> ring_;
  std::vector<Poly> relations_;
  std::map<NodeId, Fraction> fractions_;
};

}  // namespace

bool proved_zero(Expr e) {
  if (is_zero(e)) return true;
  if (is_number(e)) return false;
  try {
    return Normalizer(e, true).zero();
  } catch (const TooLarge&) {
    return false;
  }
}

std::optional<Expr> expanded(Expr e) {
  try {
    return Normalizer(e, false).expand();
  } catch (const TooLarge&) {
    return std::nullopt;
  }
}

}  // namespace anholon
