#include "proof/few_functions.h"

#include <algorithm>
#include <map>
#include <optional>
#include <unordered_map>

#include "expr/normal.h"
#include "proof/by_signs.h"

namespace anholon {

namespace {

constexpr long kMostOfArgument = 20'000;  // products of terms, to reduce an argument

// The treatment of logarithms: kept, or split into those of absolute values of factors: ln(x^2 y) is ln(x^2) +
// ln(y^2)/2.
enum class Logarithms : std::uint8_t { kept, split };

class Rewriting {
 public:
  Rewriting(Graph& g, Logarithms logarithms) : g_(g), logarithms_(logarithms) {}

  Expr of(Expr e) {
    for (const NodeId id : reachable({&e, 1})) done_.emplace(id, rewritten(id));
    return done_.at(e.id);
  }

 private:
  using Factors = std::map<NodeId, Rational>;

  Expr at(NodeId id) const { return done_.at(id); }
  // Returns a copy, because the terms of the graph move when it grows.
  std::vector<Term> terms_of(NodeId id) const { return {g_.terms(id).begin(), g_.terms(id).end()}; }
  Expr node(NodeId id) { return {&g_, id}; }

  Expr rewritten(NodeId id) {
    switch (g_.node(id).kind) {
    case Kind::sum: {
      std::vector<std::pair<Rational, Expr>> terms;
      for (const Term& t : g_.summands(id)) terms.push_back({g_.rational(t.weight), at(t.node)});
      return g_.sum(terms);
    }
    case Kind::product:
      return product(id);
    case Kind::function:
      return function(static_cast<Function>(g_.node(id).index), at(g_.terms(id)[0].node));
    case Kind::atan2:
      return atan2(reduced(at(g_.terms(id)[0].node)), reduced(at(g_.terms(id)[1].node)));
    case Kind::select:
      return select(reduced(at(g_.terms(id)[0].node)), at(g_.terms(id)[1].node), at(g_.terms(id)[2].node));
    case Kind::lookup:
      return g_.lookup(g_.node(id).index, reduced(at(g_.terms(id)[0].node)));
    case Kind::number:
    case Kind::pi:
    case Kind::time:
    case Kind::jet:
    case Kind::parameter:
    case Kind::mass:
    case Kind::multiplier:
    case Kind::given:
    case Kind::quasi:
    case Kind::state:
    case Kind::control:
      break;
    }
    return node(id);
  }

  Expr function(Function f, Expr u) {
    switch (f) {
    case Function::abs:
      return root(u * u, {1, 2});
    case Function::exp:
      return exponential(u);
    case Function::sinh:
      return Rational(1, 2) * (exponential(u) - pow(exponential(u), -1));
    case Function::cosh:
      return Rational(1, 2) * (exponential(u) + pow(exponential(u), -1));
    case Function::tanh: {
      const Expr square = pow(exponential(u), 2);
      return (square - 1) / (1 + square);
    }
    case Function::log:
      if (logarithms_ == Logarithms::split) return logarithm(u, 0);
      return log(reduced(u));
    case Function::asin:
    case Function::acos:
    case Function::atan:
      if (const auto angle = known_angle(f, u)) return *angle;
      return g_.apply(f, reduced(u));
    case Function::sin:
    case Function::cos:
      return of_angle(u, f == Function::cos);
    case Function::tan:
      return of_angle(u, false) / of_angle(u, true);
    default:
      return g_.apply(f, reduced(u));
    }
  }

  // Returns sin u or cos u. If u contains a multiple of pi/12 (the graph takes out multiples of pi/2), this multiple
  // has numbers as its sine and cosine. The zero test expands other sums.
  Expr of_angle(Expr u, bool cosine) {
    const Function f = cosine ? Function::cos : Function::sin;
    const std::optional<Rational> turns = multiple_of_pi(u);
    const Rational twelfths = turns ? 12 * *turns : Rational(0);
    if (!turns || !twelfths.is_integer() || abs(twelfths) > 3) return g_.apply(f, u);
    const Expr rest = u - *turns * g_.pi(), two = sqrt(g_.number(2)), three = sqrt(g_.number(3));
    const Expr sines[] = {g_.zero(), Rational(1, 4) * two * (three - g_.one()), g_.number({1, 2}),
                          Rational(1, 2) * two};
    const Expr cosines[] = {g_.one(), Rational(1, 4) * two * (three + g_.one()), Rational(1, 2) * three, sines[3]};
    const long k = abs(twelfths).to_long();
    const Expr c = cosines[k], s = twelfths < 0 ? -sines[k] : sines[k];
    return cosine ? cos(rest) * c - sin(rest) * s : sin(rest) * c + cos(rest) * s;
  }
  std::optional<Rational> multiple_of_pi(Expr u) const {
    if (g_.node(u.id).kind != Kind::sum) return std::nullopt;
    for (const Term& t : g_.terms(u.id))
      if (g_.node(t.node).kind == Kind::pi) return g_.rational(t.weight);
    return std::nullopt;
  }

  Expr reduced(Expr u) {
    if (is_number(u)) return u;
    return expanded(u, kMostOfArgument).value_or(u);
  }

  // Returns the angle of asin, acos or atan if it is a rational multiple of pi at a rational argument.
  std::optional<Expr> known_angle(Function f, Expr u) {
    if (!is_number(u)) return std::nullopt;
    const Rational x = number_value(u);
    std::optional<Rational> part;  // the fraction of pi
    if (f == Function::atan && abs(x) == 1) part = x / 4;
    if (f != Function::atan && (x == 0 || abs(x) == 1)) part = x / 2;
    if (f != Function::atan && abs(x) == Rational(1, 2)) part = x / 3;
    if (!part) return std::nullopt;
    return (f == Function::acos ? Rational(1, 2) - *part : *part) * g_.pi();
  }

  // Returns ln u, which is ln |u| for u > 0, as the sum of r_i ln(b_i^2)/2 over the factors b_i^r_i of u.
  Expr logarithm(Expr u, int depth) {
    constexpr int kDeepest = 8;  // roots within roots
    u = reduced(u);
    if (is_number(u)) return logarithm_of(number_value(u));
    if (depth == kDeepest) return log(u);
    Expr all = g_.zero();
    NodeId factors = u.id;
    if (g_.node(u.id).kind == Kind::sum && g_.terms(u.id).size() == 1) {
      all = logarithm_of(abs(g_.rational(g_.terms(u.id)[0].weight)));
      factors = g_.terms(u.id)[0].node;
    }
    for (const auto& [base, power] : factors_of(factors)) {
      const Node& n = g_.node(base);
      const bool nested = n.kind == Kind::product || (n.kind == Kind::sum && g_.terms(base).size() == 1);
      const bool of_exp = n.kind == Kind::function && static_cast<Function>(n.index) == Function::exp;
      const Expr b = node(base);
      all = all + power * (of_exp   ? node(g_.terms(base)[0].node)
                           : nested ? logarithm(b, depth + 1)
                                    : Rational(1, 2) * log(reduced(b * b)));
    }
    return all;
  }
  // Returns the logarithm of a number by its small prime factors.
  Expr logarithm_of(Rational x) {
    constexpr unsigned long kLargest = 100;
    if (x <= 0) return log(g_.number(x));
    Expr all = g_.zero();
    for (const int sign : {1, -1}) {
      mpz_class rest = sign > 0 ? x.get_num() : x.get_den();
      for (unsigned long p = 2; p < kLargest && rest > 1; ++p)
        for (; mpz_divisible_ui_p(rest.get_mpz_t(), p); rest /= p)
          all = all + Rational(sign) * log(g_.number(static_cast<long>(p)));
      if (rest > 1) all = all + Rational(sign) * log(g_.number(Rational(rest)));
    }
    return all;
  }

  // Returns exp(c_1 a_1 + c_2 a_2 + …) as the product of exp(a_i)^c_i, which is y^c_i if a_i is ln y.
  Expr exponential(Expr u) {
    u = reduced(u);
    if (g_.node(u.id).kind != Kind::sum) return exponential_of(u.id, 1);
    Expr all = g_.one();
    for (const Term& t : terms_of(u.id)) all = all * exponential_of(t.node, g_.rational(t.weight));
    return all;
  }
  Expr exponential_of(NodeId a, Rational c) {
    const Node& n = g_.node(a);
    const bool of_log = n.kind == Kind::function && static_cast<Function>(n.index) == Function::log;
    return pow(of_log ? node(g_.terms(a)[0].node) : exp(node(a)), c);
  }

  // Rewrites a product: u sign(u) is |u|, and |u| sign(u) is u, also if u is zero.
  Expr product(NodeId id) {
    Factors factors;
    for (const Term& t : g_.terms(id)) factors[t.node] = g_.rational(t.weight);
    Expr all = g_.one();
    for (const Term& t : terms_of(id)) {
      const Node& n = g_.node(t.node);
      if (n.kind != Kind::function || static_cast<Function>(n.index) != Function::sign) continue;
      all = all * without_sign(factors, t.node, g_.terms(t.node)[0].node);
    }
    for (const auto& [base, power] : factors)
      all = all * (power.is_integer() ? pow(at(base), power) : root(at(base), power));
    return all;
  }
  // Removes sign(u) from the factors if they contain u or |u|, and returns the factor that replaces both; 1 if it stays
  // among the factors.
  Expr without_sign(Factors& factors, NodeId sign, NodeId u) {
    const auto positive = [](const Rational& r) { return r.is_integer() && r > 0; };
    const Rational power = factors.at(sign);
    if (!positive(power)) return g_.one();
    const bool odd = !Rational(power / 2).is_integer();
    const auto own = factors.find(u), absolute = factors.find(abs(node(u)).id);
    if (own != factors.end() && positive(own->second)) {
      factors.erase(sign);
      if (!odd) return g_.one();
      own->second = own->second - 1;
      return root(at(u) * at(u), {1, 2});
    }
    if (absolute != factors.end() && positive(absolute->second)) {
      factors.erase(sign);
      if (!odd) return g_.one();
      absolute->second = absolute->second - 1;
      return at(u);
    }
    return g_.one();
  }

  // Returns x^e for a fraction e. For square roots, even powers of factors common to all terms of x are taken out of
  // the root.
  Expr root(Expr x, const Rational& e) {
    x = reduced(x);
    if (is_number(x)) return root_of_number(number_value(x), e);
    if (e.get_den() != 2) return pow(x, e);
    Factors common = even_powers(x.id);
    Expr before = g_.one();
    for (const auto& [base, power] : common) {
      const Rational half = power / 2 * e.get_num();
      const Expr b = node(base);
      x = x * pow(b, -power);
      before = before * (Rational(half / 2).is_integer() ? pow(b, half) : pow(pow(pow(b, 2), {1, 2}), half));
    }
    if (!common.empty()) x = reduced(x);
    return before * pow(x, e);
  }

  // Returns the root of a number by its prime factors: sqrt(6) is sqrt(2) sqrt(3).
  Expr root_of_number(Rational x, const Rational& e) {
    constexpr long kLargest = 1'000'000;
    if (!(x > 0) || x.get_num() > kLargest || x.get_den() > kLargest) return pow(g_.number(x), e);
    Expr all = g_.one();
    for (const auto& [whole, power] : {std::pair{x.get_num(), e}, std::pair{x.get_den(), -e}})
      for (long left = whole.get_si(), p = 2; left > 1; p = p * p <= left ? p + 1 : left)
        for (; left % p == 0; left /= p) all = all * pow(g_.number(p), power);
    return all;
  }

  // Returns the even powers of the factors that all terms have.
  Factors even_powers(NodeId x) {
    Factors common;
    if (g_.node(x).kind != Kind::sum) return even(factors_of(x));
    bool first = true;
    for (const Term& t : g_.terms(x)) {
      const Factors own = factors_of(t.node);
      if (std::exchange(first, false)) {
        common = own;
        continue;
      }
      Factors both;
      for (const auto& [base, power] : common)
        if (const auto k = own.find(base); k != own.end()) both[base] = std::min(power, k->second);
      common = std::move(both);
    }
    return even(common);
  }
  Factors factors_of(NodeId x) const {
    Factors list;
    if (g_.node(x).kind == Kind::product)
      for (const Term& t : g_.terms(x)) list[t.node] = g_.rational(t.weight);
    else if (!g_.is_number(x))
      list[x] = 1;
    return list;
  }
  static Factors even(const Factors& of) {
    Factors list;
    for (const auto& [base, power] : of) {
      if (!power.is_integer() || power < 2) continue;
      list[base] = Rational(power / 2).is_integer() ? power : power - 1;
    }
    return list;
  }

  Graph& g_;
  Logarithms logarithms_;
  std::unordered_map<NodeId, Expr> done_;
};

}  // namespace

Expr in_few_functions(Expr e) { return Rewriting(*e.graph, Logarithms::kept).of(e); }
Expr with_split_logarithms(Expr e) { return Rewriting(*e.graph, Logarithms::split).of(e); }

namespace {

// True if e contains a function, or a root, that would be rewritten.
bool may_be_written_anew(Expr e) {
  const Graph& g = *e.graph;
  const std::vector<NodeId> ids = reachable({&e, 1});
  return std::any_of(ids.begin(), ids.end(), [&](NodeId id) {
    const Node& n = g.node(id);
    if (n.kind == Kind::function) {
      const Function f = static_cast<Function>(n.index);
      if (f != Function::sin && f != Function::cos) return true;
      const std::span<const Term> terms = g.terms(g.terms(id)[0].node);
      return std::any_of(terms.begin(), terms.end(), [&](const Term& t) { return g.node(t.node).kind == Kind::pi; });
    }
    if (n.kind != Kind::product) return n.kind == Kind::atan2 || n.kind == Kind::select || n.kind == Kind::lookup;
    const std::span<const Term> terms = g.terms(id);
    return std::any_of(terms.begin(), terms.end(), [&](const Term& t) { return !g.rational(t.weight).is_integer(); });
  });
}

bool holds_logarithm(Expr e) {
  const std::vector<NodeId> ids = reachable({&e, 1});
  return std::any_of(ids.begin(), ids.end(), [&](NodeId id) {
    const Node& n = e.graph->node(id);
    return n.kind == Kind::function && static_cast<Function>(n.index) == Function::log;
  });
}

bool shown_zero_in(Expr few, Expr e, Effort effort) { return !(few == e) && shown_zero(few, effort); }

// True if e is shown to be zero in one of the two rewritings.
bool shown_zero_written_anew(Expr e, Effort effort) {
  return shown_zero_in(in_few_functions(e), e, effort) ||
         (holds_logarithm(e) && shown_zero_in(with_split_logarithms(e), e, effort));
}

}  // namespace

bool shown_zero_in_few_functions(Expr e, Effort effort) {
  if (shown_zero(e, effort)) return true;
  if (!may_be_written_anew(e)) return false;
  try {
    return shown_zero_written_anew(e, effort) || shown_zero_by_signs(e, [&](Expr in_case) {
             return shown_zero(in_case, effort) || shown_zero_written_anew(in_case, effort);
           });
  } catch (const Failure&) {
    return false;  // a denominator vanishes
  }
}

}  // namespace anholon
