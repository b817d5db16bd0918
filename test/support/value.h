// The value of an expression by its definition, in multiprecision, from the operands of each node. It shares no code
// with the tape, and it uses the flat terms of sums, never their short form, so it can check both.
#pragma once
#include <functional>
#include <map>
#include <vector>

#include "expr/expr.h"
#include "numeric/number.h"

namespace anholon::test {

// Values of symbols: pseudo-random ones in (-1.5, 1.5) that depend on the symbol and the seed, unless set.
class Point {
 public:
  explicit Point(std::uint64_t seed = 1) : seed_(seed) {}

  Point& set(Expr symbol, const Multi& value) {
    fixed_.insert_or_assign(symbol.id, value);
    return *this;
  }
  Point& set_parameters(const std::vector<Multi>& values) {
    parameters_ = values;
    return *this;
  }
  Multi operator()(const Graph& g, NodeId id) const {
    if (const auto it = fixed_.find(id); it != fixed_.end()) return it->second;
    const Node& n = g.node(id);
    if (n.kind == Kind::parameter && n.index < parameters_.size()) return parameters_[n.index];
    std::uint64_t h =
        seed_ * 0x9e3779b97f4a7c15ULL + static_cast<std::uint64_t>(n.kind) * 1000003 + n.index * 131 + n.order;
    for (int i = 0; i < 3; ++i) h = (h ^ (h >> 29)) * 0xbf58476d1ce4e5b9ULL;
    return Multi(static_cast<double>(h >> 40)) * Multi(3) / Multi(16777216.0) - Multi(1.5);
  }

 private:
  std::uint64_t seed_;
  std::map<NodeId, Multi> fixed_;
  std::vector<Multi> parameters_;
};

inline Multi apply(Function f, const Multi& u) {
  switch (f) {
#define ROW(name, ...)                                                                                                 \
  case Function::name:                                                                                                 \
    return name(u);
#include "expr/elementary.def"
#undef ROW
  }
  return u;
}

inline Multi raise(const Multi& base, const Rational& exponent) {
  Multi r;
  if (exponent.is_integer())
    mpfr_pow_si(r.raw(), base.raw(), exponent.to_long(), MPFR_RNDN);
  else
    r = pow(base, Multi(exponent));
  return r;
}

inline std::vector<Multi> values(std::span<const Expr> es, const Point& at) {
  std::vector<Multi> out;
  if (es.empty()) return out;
  const Graph& g = *es[0].graph;
  std::map<NodeId, Multi> value;
  for (NodeId id : reachable(es)) {
    const Node& n = g.node(id);
    Multi v(0);
    switch (n.kind) {
    case Kind::number:
      v = Multi(g.value(id));
      break;
    case Kind::pi:
      v = pi<Multi>();
      break;
    case Kind::time:
    case Kind::jet:
    case Kind::parameter:
    case Kind::mass:
    case Kind::multiplier:
    case Kind::given:
    case Kind::quasi:
    case Kind::state:
    case Kind::control:
      v = at(g, id);
      break;
    case Kind::sum:
      for (const Term& t : g.terms(id)) {
        const Multi operand = g.is_number(t.node) ? Multi(g.value(t.node)) : value.at(t.node);
        v += Multi(g.rational(t.weight)) * operand;
      }
      break;
    case Kind::product:
      v = Multi(1);
      for (const Term& t : g.terms(id)) v *= raise(value.at(t.node), g.rational(t.weight));
      break;
    case Kind::function:
      v = apply(static_cast<Function>(n.index), value.at(g.terms(id)[0].node));
      break;
    case Kind::select:
      v = value.at(g.terms(id)[!(value.at(g.terms(id)[0].node) < Multi(0)) ? 1 : 2].node);
      break;
    case Kind::lookup: {
      const StepFunction& f = g.step_function(n.index);
      std::size_t k = 0;
      while (k < f.knots.size() && !(value.at(g.terms(id)[0].node) < Multi(f.knots[k]))) ++k;
      v = Multi(f.values[k]);
      break;
    }
    case Kind::atan2:
      v = atan2(value.at(g.terms(id)[0].node), value.at(g.terms(id)[1].node));
      break;
    }
    value.insert_or_assign(id, v);
  }
  for (Expr e : es) out.push_back(value.at(e.id));
  return out;
}

inline Multi value(Expr e, const Point& at) { return values({&e, 1}, at)[0]; }

// |a - b| in units of the larger of |a|, |b| and 1.
inline double distance(const Multi& a, const Multi& b) {
  Multi scale(1);
  for (const Multi* v : {&a, &b})
    if (abs(*v) > scale) scale = abs(*v);
  const double d = to_double(Multi(abs(Multi(a - b)) / scale));
  return d == d ? d : 1e300;  // NaN is far from everything
}

// Taylor coefficients f^(k)(0)/k!, k <= orders, by central differences: their error is of order h^2, and the precision
// includes the digits that the differences cancel.
inline std::vector<Multi> taylor_by_differences(const std::function<Multi(const Multi&)>& f, int orders) {
  const PrecisionScope precision(30 * orders + 80);
  const Multi h = raise(Multi(10), Rational(-25));
  std::vector<Multi> out;
  Multi factorial(1);
  for (int k = 0; k <= orders; ++k) {
    if (k > 0) factorial *= Multi(k);
    Multi difference(0), binomial(1);
    for (int j = 0; j <= k; ++j) {
      const Multi term = binomial * f((Multi(k) / Multi(2) - Multi(j)) * h);
      if (j % 2)
        difference -= term;
      else
        difference += term;
      binomial = binomial * Multi(k - j) / Multi(j + 1);
    }
    out.push_back(difference / (factorial * raise(h, Rational(k))));
  }
  return out;
}

}  // namespace anholon::test
