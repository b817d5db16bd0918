// Functions and branches of expressions: their tables, and their values where these are exact.
#include <algorithm>
#include <array>

#include "base/assert.h"
#include "expr/expr.h"

namespace anholon {

namespace {

enum class Parity : std::uint8_t { none, even, odd };

enum Beyond : bool { shows = false, hides = true };

constexpr std::array kFunctions = {
#define ROW(name, derivative, antiderivative, parity, exact, beyond, latex, c, numpy, undefined)                       \
  FunctionInfo{#name, latex, c, numpy, undefined, beyond},
#include "expr/elementary.def"
#undef ROW
};

constexpr std::array kParity = {
#define ROW(name, derivative, antiderivative, parity, ...) Parity::parity,
#include "expr/elementary.def"
#undef ROW
};

Parity parity(Function f) { return kParity[static_cast<std::size_t>(f)]; }

// Returns the value at a rational argument, if it is rational and known.
std::optional<Rational> exact_value(Function f, const Rational& x) {
  const auto at = [&](int argument, int value) {
    return x == argument ? std::optional<Rational>(value) : std::nullopt;
  };
  switch (f) {
#define ROW(name, derivative, antiderivative, parity, exact, ...)                                                      \
  case Function::name:                                                                                                 \
    return exact;
#include "expr/elementary.def"
#undef ROW
  }
  return std::nullopt;
}

// True if the expression is written with a leading minus sign.
bool negative(const Graph& g, NodeId id) {
  const Node& n = g.node(id);
  if (n.kind == Kind::number) return g.value(id) < 0;
  return n.kind == Kind::sum && g.rational(g.terms(id)[0].weight) < 0;
}

// The expression x = rest + turns * pi.
struct Turned {
  Rational turns;
  Expr rest;
};

// Returns nullopt if x holds no multiple of pi as a term.
std::optional<Turned> turned(Graph& g, NodeId x) {
  const Node& n = g.node(x);
  if (n.kind == Kind::pi) return Turned{1, g.zero()};
  if (n.kind != Kind::sum) return std::nullopt;
  for (const Term& t : g.terms(x))
    if (g.node(t.node).kind == Kind::pi) {
      const Rational turns = g.rational(t.weight);
      return Turned{turns, Expr{&g, x} - turns * Expr{&g, t.node}};
    }
  return std::nullopt;
}

// Returns sin(k pi/12) for k = 0 to 3; the others follow from these.
std::optional<Expr> sine_of_twelfths(Graph& g, unsigned long k) {
  switch (k) {
  case 0:
    return g.zero();
  case 2:
    return g.number(Rational(1, 2));
  case 3:
    return Rational(1, 2) * sqrt(g.number(2));
  default:
    return std::nullopt;
  }
}

// Returns cos(k pi/12) for k = 0 to 3.
std::optional<Expr> cosine_of_twelfths(Graph& g, unsigned long k) {
  switch (k) {
  case 0:
    return g.one();
  case 2:
    return Rational(1, 2) * sqrt(g.number(3));
  case 3:
    return Rational(1, 2) * sqrt(g.number(2));
  default:
    return std::nullopt;
  }
}

// Returns sin x, or cos x = sin(x + pi/2), for an x with a multiple of pi as a term: the remainder of that term is
// between -pi/4 and pi/4, so sin(x + pi/2) becomes cos x and sin(x + pi/3) becomes cos(x - pi/6). Returns nullopt if
// nothing can be taken out.
std::optional<Expr> sine_of_turned(Graph& g, bool cosine, Expr x) {
  const std::optional<Turned> t = turned(g, x.id);
  if (!t) return std::nullopt;
  // Of two nearest whole numbers, the one next to 0 is taken: -x then has the same one with the other sign, so parity
  // does not change the form.
  const Rational nearest = -floor(Rational(1, 2) - 2 * abs(t->turns)), quarters = t->turns < 0 ? -nearest : nearest;
  const Rational left = t->turns - quarters / 2;
  const Rational four = 4, k = quarters + (cosine ? 1 : 0);
  const long quarter = Rational(k - four * floor(k / four)).to_long();  // sin(x + quarter pi/2)
  const Rational sign = quarter >= 2 ? -1 : 1;
  if (is_zero(t->rest)) {
    const Rational twelfths = 12 * abs(left);
    if (twelfths.is_integer()) {
      const auto n = static_cast<unsigned long>(twelfths.to_long());
      const auto v = quarter % 2 == 1 ? cosine_of_twelfths(g, n) : sine_of_twelfths(g, n);
      if (v) return (quarter % 2 == 0 && left < 0 ? -sign : sign) * *v;
    }
  }
  // cos(x + pi/4) is -sin(x - pi/4): one of the two ways to write it is chosen.
  if (quarter % 2 == 1 && abs(left) == Rational(1, 4))
    return (left > 0 ? -sign : sign) * g.apply(Function::sin, t->rest - left * g.pi());
  if (quarters == 0) return std::nullopt;
  const Expr rest = left == 0 ? t->rest : t->rest + left * g.pi();
  return sign * g.apply(quarter % 2 == 1 ? Function::cos : Function::sin, rest);
}

}  // namespace

const FunctionInfo& info(Function f) { return kFunctions[static_cast<std::size_t>(f)]; }

std::span<const FunctionInfo> elementary_functions() { return kFunctions; }

int find_function(const std::string& name) {
  for (std::size_t i = 0; i < kFunctions.size(); ++i)
    if (name == kFunctions[i].name) return static_cast<int>(i);
  return -1;
}

Expr Graph::apply(Function f, Expr x) {
  if (is_number(x.id))
    if (auto v = exact_value(f, value(x.id))) return number(*v);
  if (f == Function::sin || f == Function::cos)
    if (const auto v = sine_of_turned(*this, f == Function::cos, x)) return *v;
  if (negative(*this, x.id)) {
    switch (parity(f)) {
    case Parity::even:
      return apply(f, -x);
    case Parity::odd:
      return -apply(f, -x);
    case Parity::none:
      break;
    }
  }
  const Term operand[] = {{0, x.id}};
  return {this, intern(Node{Kind::function, 0, static_cast<std::uint32_t>(f)}, operand, {})};
}

Expr Graph::arctangent2(Expr y, Expr x) {
  if (anholon::is_zero(y) && anholon::is_number(x) && number_value(x) > 0) return zero();
  const Term operands[] = {{0, y.id}, {0, x.id}};
  return {this, intern(Node{Kind::atan2}, operands, {})};
}

Expr Graph::select(Expr s, Expr a, Expr b) {
  if (a == b) return a;
  if (is_number(s.id)) return value(s.id) >= 0 ? a : b;
  const Term operands[] = {{0, s.id}, {0, a.id}, {0, b.id}};
  return {this, intern(Node{Kind::select}, operands, {})};
}

Expr Graph::lookup(std::uint32_t f, Expr x) {
  const StepFunction& table = step_functions_[f];
  if (std::all_of(table.values.begin(), table.values.end(), [&](const Rational& v) { return v == table.values[0]; }))
    return number(table.values[0]);
  if (is_number(x.id)) {
    const auto above = std::upper_bound(table.knots.begin(), table.knots.end(), value(x.id));
    return number(table.values[static_cast<std::size_t>(above - table.knots.begin())]);
  }
  const Term operand[] = {{0, x.id}};
  return {this, intern(Node{Kind::lookup, 0, f}, operand, {})};
}

#define ROW(name, ...)                                                                                                 \
  Expr name(Expr u) { return u.graph->apply(Function::name, u); }
#include "expr/elementary.def"
#undef ROW

Expr select(Expr s, Expr a, Expr b) { return s.graph->select(s, a, b); }
Expr atan2(Expr y, Expr x) { return y.graph->arctangent2(y, x); }

}  // namespace anholon
