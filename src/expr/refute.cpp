#include "expr/refute.h"

#include <algorithm>
#include <array>
#include <map>
#include <unordered_map>

#include "numeric/prime_field.h"
#include "numeric/random/philox.h"

namespace anholon {

namespace {

using Word = PrimeField::Word;

// p = 2r + 1 with r prime: half the field are squares, each of which has exactly one root of any degree that is a
// square.
constexpr Word kPrime = 2305843009213057079;
// The number of points that are tried until roots and reciprocals have values: each even root has one at half of the
// points.
constexpr int kMostPoints = 24;

struct NoValue {};

class FieldPoint {
 public:
  explicit FieldPoint(Expr root) : g_(*root.graph), root_(root) {
    find_nodes();
    for (NodeId id : ids_)
      if (trigonometric(g_.node(id)))
        for (const auto& [atom, c] : angle(id)) q_ = lcm(q_, c.get_den());
  }

  // True if the expression vanishes at the point. Throws NoValue if a part has no value.
  bool zero_at(std::uint32_t point) {
    point_ = point;
    values_.resize(ids_.size());
    circle_.clear();
    for (std::size_t i = 0; i < ids_.size(); ++i) values_[i] = value(ids_[i]);
    return values_.back() == 0;
  }

 private:
  struct Circle {
    Word sin, cos;
  };

  // Collects the nodes ascending, with the root last, without nodes below a function.
  void find_nodes() {
    ids_.push_back(root_.id);
    at_.emplace(root_.id, 0);
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      const Node& n = g_.node(ids_[i]);
      if (n.kind != Kind::sum && n.kind != Kind::product) continue;
      for (const Term& t : g_.summands(ids_[i]))
        if (at_.try_emplace(t.node, 0).second) ids_.push_back(t.node);
    }
    std::sort(ids_.begin(), ids_.end());
    for (std::size_t i = 0; i < ids_.size(); ++i) at_[ids_[i]] = i;
  }
  Word known(NodeId id) const { return values_[at_.at(id)]; }

  static bool trigonometric(const Node& n) {
    if (n.kind != Kind::function) return false;
    const Function f = static_cast<Function>(n.index);
    return f == Function::sin || f == Function::cos || f == Function::tan;
  }
  std::vector<std::pair<NodeId, Rational>> angle(NodeId function) const {
    const NodeId x = g_.terms(function)[0].node;
    if (g_.node(x).kind != Kind::sum) return {{x, 1}};
    std::vector<std::pair<NodeId, Rational>> parts;
    for (const Term& t : g_.terms(x)) parts.push_back({t.node, g_.rational(t.weight)});
    return parts;
  }

  Word random(NodeId id, std::uint32_t use) const {
    const auto bits = philox({id, point_, use, 0}, {});
    return ((static_cast<Word>(bits[0]) << 32) | bits[1]) % kPrime;
  }
  Word number(const Rational& r) const {
    const std::optional<Word> w = f_.from(r);
    if (!w) throw NoValue{};
    return *w;
  }
  Word inverse(Word x) const {
    if (x == 0) throw NoValue{};
    return f_.inverse(x);
  }

  Circle turned(Circle a, Circle b) const {
    return {f_.add(f_.multiply(a.sin, b.cos), f_.multiply(a.cos, b.sin)),
            f_.subtract(f_.multiply(a.cos, b.cos), f_.multiply(a.sin, b.sin))};
  }
  // Returns the point of the circle for the atom divided by q.
  Circle base(NodeId atom) {
    const auto [it, fresh] = circle_.try_emplace(atom);
    if (fresh) {
      const Word t = random(atom, 1), tt = f_.multiply(t, t), below = f_.inverse(f_.add(1, tt));  // -1 is no square
      it->second = {f_.multiply(f_.add(t, t), below), f_.multiply(f_.subtract(1, tt), below)};
    }
    return it->second;
  }
  Circle sine_cosine(NodeId function) {
    Circle all{0, 1};
    for (const auto& [atom, c] : angle(function)) {
      const mpz_class multiple = Rational(c * q_).get_num();
      if (!multiple.fits_slong_p()) throw NoValue{};
      const long k = multiple.get_si();
      Circle power = base(atom);
      if (k < 0) power.sin = f_.negate(power.sin);
      for (unsigned long n = k < 0 ? -static_cast<unsigned long>(k) : static_cast<unsigned long>(k); n > 0;
           n >>= 1, power = turned(power, power))
        if (n & 1) all = turned(all, power);
    }
    return all;
  }

  Word root(Word x, const mpz_class& k) const {
    if (k == 1 || x == 0) return x;
    if (!f_.is_square(x)) throw NoValue{};
    mpz_class exponent;
    if (!mpz_invert(exponent.get_mpz_t(), k.get_mpz_t(), mpz_class((kPrime - 1) / 2).get_mpz_t())) throw NoValue{};
    return f_.power(x, exponent.get_ui());
  }
  Word power(Word x, const Rational& e) const {
    if (e == 1) return x;
    if (!e.fits_long()) throw NoValue{};
    const long n = e.to_long();
    const Word r = root(x, e.get_den());
    return n < 0 ? f_.power(inverse(r), -static_cast<unsigned long>(n)) : f_.power(r, static_cast<unsigned long>(n));
  }

  Word value(NodeId id) {
    const Node& n = g_.node(id);
    switch (n.kind) {
    case Kind::number:
      return number(g_.value(id));
    case Kind::sum: {
      Word total = 0;
      for (const Term& t : g_.summands(id)) {
        const Rational& c = g_.rational(t.weight);
        total = f_.add(total, c == 1 ? known(t.node) : f_.multiply(number(c), known(t.node)));
      }
      return total;
    }
    case Kind::product: {
      Word total = 1;
      for (const Term& t : g_.terms(id)) total = f_.multiply(total, power(known(t.node), g_.rational(t.weight)));
      return total;
    }
    case Kind::function:
      if (trigonometric(n)) {
        const Circle c = sine_cosine(id);
        switch (static_cast<Function>(n.index)) {
        case Function::sin:
          return c.sin;
        case Function::cos:
          return c.cos;
        default:
          return f_.multiply(c.sin, inverse(c.cos));  // tan
        }
      }
      return random(id, 0);
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
      return random(id, 0);
    }
    return 0;
  }

  const Graph& g_;
  Expr root_;
  PrimeField f_{kPrime};
  std::uint32_t point_ = 0;
  std::vector<NodeId> ids_;
  std::unordered_map<NodeId, std::size_t> at_;
  mpz_class q_ = 1;  // common denominator of the multiples of angles
  std::vector<Word> values_;
  std::map<NodeId, Circle> circle_;
};

}  // namespace

bool refuted(Expr e) {
  FieldPoint at(e);
  for (int k = 0; k < kMostPoints; ++k) try {
      return !at.zero_at(static_cast<std::uint32_t>(k));
    } catch (const NoValue&) {
    }
  return false;
}

}  // namespace anholon
