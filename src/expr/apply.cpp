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

// The value at a rational argument, if it is rational and known.
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

// sin and cos at a rational multiple of pi with rational value.
std::optional<Rational> value_at_pi(const Graph& g, Function f, NodeId x) {
  const Node& n = g.node(x);
  Rational turns;  // x = turns * pi
  if (n.kind == Kind::pi)
    turns = 1;
  else if (n.kind == Kind::sum && n.count == 1 && g.node(g.terms(x)[0].node).kind == Kind::pi)
    turns = g.rational(g.terms(x)[0].weight);
  else
    return std::nullopt;
  if (f != Function::sin && f != Function::cos) return std::nullopt;
  Rational sixths = turns * 6;
  if (!sixths.is_integer()) return std::nullopt;
  mpz_class k = f == Function::cos ? mpz_class(sixths.get_num() + 3) : sixths.get_num();
  const unsigned long step = mpz_fdiv_ui(k.get_mpz_t(), 12);  // sin(step * pi/6)
  switch (step) {
  case 0:
  case 6:
    return Rational(0);
  case 1:
  case 5:
    return Rational(1, 2);
  case 3:
    return Rational(1);
  case 7:
  case 11:
    return Rational(-1, 2);
  case 9:
    return Rational(-1);
  default:
    return std::nullopt;
  }
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
  if (auto v = value_at_pi(*this, f, x.id)) return number(*v);
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
