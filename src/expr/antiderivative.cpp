#include "expr/antiderivative.h"

#include <algorithm>

#include "expr/normal.h"

namespace anholon {

namespace {

// An expression with more nodes is not integrated: the result would be too long to read.
constexpr std::size_t kLongest = 200;
constexpr int kMostParts = 20;  // the highest power that is integrated by parts

bool holds(Expr e, Expr z) {
  const std::vector<NodeId> found = symbols({&e, 1});
  return std::binary_search(found.begin(), found.end(), z.id);
}

// Returns e written without z, if that is possible.
std::optional<Expr> without(Expr e, Expr z) {
  if (!holds(e, z)) return e;
  if (reachable({&e, 1}).size() > kLongest) return std::nullopt;
  const std::optional<Expr> short_one = expanded(e);
  if (short_one && !holds(*short_one, z)) return short_one;
  return std::nullopt;
}

Expr divided(Expr a, Expr b) {
  const Expr q = a / b;
  if (is_number(q) || reachable({&q, 1}).size() > kLongest) return q;
  return expanded(q).value_or(q);
}

// Returns the antiderivative of f(u)^k by u. Nodes are made in sequence: their order must not depend on the compiler.
std::optional<Expr> of_function(Function f, Expr u, const Rational& k) {
  if (k == 1) {
    constexpr std::nullopt_t none = std::nullopt;
    switch (f) {
#define ROW(name, derivative, antiderivative, ...)                                                                     \
  case Function::name:                                                                                                 \
    return antiderivative;
#include "expr/elementary.def"
#undef ROW
    }
  }
  if (f == Function::exp) return (1 / k) * pow(exp(u), k);
  if (f != Function::sin && f != Function::cos) return std::nullopt;
  const Expr s = sin(u), c = cos(u);
  if (k == 2) return f == Function::sin ? Rational(1, 2) * (u - s * c) : Rational(1, 2) * (u + s * c);
  if (k == -2) return f == Function::sin ? -(c / s) : s / c;
  return std::nullopt;
}

// Returns r with r^2 = e, where e is a product of even powers.
std::optional<Expr> square_root(Expr e) {
  Graph& g = *e.graph;
  std::vector<std::pair<Expr, Rational>> half;
  const auto rational_root = [](const Rational& r) -> std::optional<Rational> {
    if (r <= 0 || !mpz_perfect_square_p(r.get_num().get_mpz_t()) || !mpz_perfect_square_p(r.get_den().get_mpz_t()))
      return std::nullopt;
    return Rational(sqrt(r.get_num()), sqrt(r.get_den()));
  };
  if (is_number(e)) {
    const std::optional<Rational> r = rational_root(number_value(e));
    return r ? std::optional<Expr>(g.number(*r)) : std::nullopt;
  }
  Rational factor = 1;
  if (const Node& n = g.node(e.id); n.kind == Kind::sum && n.count == 1) {
    const std::optional<Rational> r = rational_root(g.rational(g.terms(e.id)[0].weight));
    if (!r) return std::nullopt;
    factor = *r;
    e = {&g, g.terms(e.id)[0].node};
  }
  if (g.node(e.id).kind != Kind::product) return std::nullopt;
  for (const Term& t : g.terms(e.id)) {
    const Rational exponent = g.rational(t.weight) / 2;
    if (!exponent.is_integer()) return std::nullopt;
    half.emplace_back(Expr{&g, t.node}, exponent);
  }
  return factor * g.product(half);
}

// Returns the antiderivative of 1/(a z^2 + b) with b/a = r^2: atan(z/r)/(a r).
std::optional<Expr> arctangent(Expr base, Expr z) {
  const std::optional<Expr> a = without(Rational(1, 2) * partial(partial(base, z), z), z);
  if (!a || is_zero(*a)) return std::nullopt;
  const std::optional<Expr> b = without(base - *a * (z * z), z);
  if (!b || is_zero(*b)) return std::nullopt;
  const std::optional<Expr> r = square_root(divided(*b, *a));
  if (!r) return std::nullopt;
  const Expr angle = atan(z / *r);
  return angle / (*a * *r);
}

struct Factor {
  Expr base;
  Rational exponent;
  Expr value() const { return pow(base, exponent); }
};

// A term as a factor without z and the factors that hold z.
struct Split {
  Expr constant;
  std::vector<Factor> factors;
};

Split split(Expr term, Expr z) {
  Graph& g = *term.graph;
  Split s{g.one(), {}};
  const auto add = [&](Expr base, const Rational& exponent) {
    if (holds(base, z))
      s.factors.push_back({base, exponent});
    else
      s.constant = s.constant * pow(base, exponent);
  };
  if (const Node& n = g.node(term.id); n.kind == Kind::sum && n.count == 1) {
    s.constant = g.number(g.rational(g.terms(term.id)[0].weight));
    term = {&g, g.terms(term.id)[0].node};
  }
  if (g.node(term.id).kind == Kind::product)
    for (const Term& t : g.terms(term.id)) add({&g, t.node}, g.rational(t.weight));
  else
    add(term, 1);
  return s;
}

// Returns the terms of a sum, or of a product that contains a sum, multiplied out once.
std::vector<Expr> terms_of(Expr e, Expr z) {
  Graph& g = *e.graph;
  const auto of_sum = [&](NodeId sum, Expr rest) {
    std::vector<Expr> out;
    for (const Term& t : g.terms(sum)) {
      const Rational weight = g.rational(t.weight);
      out.push_back(weight * (Expr{&g, t.node} * rest));
    }
    return out;
  };
  const Node& n = g.node(e.id);
  if (n.kind == Kind::sum) return of_sum(e.id, g.one());
  if (n.kind == Kind::product)
    for (const Term& t : g.terms(e.id))
      if (g.rational(t.weight) == 1 && g.node(t.node).kind == Kind::sum && holds({&g, t.node}, z))
        return of_sum(t.node, e / Expr{&g, t.node});
  return {e};
}

std::optional<Expr> of_terms(Expr e, Expr z, int parts);

std::optional<Expr> of_term(Expr term, Expr z, int parts) {
  const Split s = split(term, z);
  if (s.factors.empty()) return s.constant * z;
  Graph& g = *term.graph;
  for (std::size_t i = 0; i < s.factors.size(); ++i) {
    const Factor& f = s.factors[i];
    Expr rest = s.constant;
    for (std::size_t j = 0; j < s.factors.size(); ++j)
      if (j != i) rest = rest * s.factors[j].value();
    // The derivative of the base divides e.
    if (const Expr d = partial(f.base, z); !is_zero(d))
      if (const std::optional<Expr> c = without(divided(rest, d), z)) {
        const Rational up = f.exponent + 1;
        return *c * (up == 0 ? log(f.base) : (1 / up) * pow(f.base, up));
      }
    if (f.exponent == -1 && !holds(rest, z))
      if (const std::optional<Expr> F = arctangent(f.base, z)) return rest * *F;
    // The derivative of the function's argument divides e.
    const Node& n = g.node(f.base.id);
    if (n.kind != Kind::function) continue;
    const Expr u{&g, g.terms(f.base.id)[0].node};
    const Expr d = partial(u, z);
    if (is_zero(d)) continue;
    const std::optional<Expr> c = without(divided(rest, d), z);
    if (!c) continue;
    if (const std::optional<Expr> F = of_function(static_cast<Function>(n.index), u, f.exponent)) return *c * *F;
  }
  // Integrates by parts, which lowers the power of z.
  if (parts >= kMostParts) return std::nullopt;
  for (const Factor& f : s.factors) {
    if (!(f.base == z) || !f.exponent.is_integer() || f.exponent < 1) continue;
    const Expr power = f.value();
    const std::optional<Expr> G = of_term(term / power, z, kMostParts);
    if (!G) return std::nullopt;
    const std::optional<Expr> rest = of_terms(partial(power, z) * *G, z, parts + 1);
    if (!rest) return std::nullopt;
    return power * *G - *rest;
  }
  return std::nullopt;
}

std::optional<Expr> of_terms(Expr e, Expr z, int parts) {
  Expr total = e.graph->zero();
  for (Expr term : terms_of(e, z)) {
    const std::optional<Expr> F = of_term(term, z, parts);
    if (!F) return std::nullopt;
    total += *F;
  }
  return total;
}

}  // namespace

std::optional<Expr> antiderivative(Expr e, Expr z) {
  if (is_zero(e)) return e;
  if (reachable({&e, 1}).size() > kLongest) return std::nullopt;
  const auto checked = [&](Expr form) -> std::optional<Expr> {
    const std::optional<Expr> F = of_terms(form, z, 0);
    if (F && reachable({&*F, 1}).size() <= 4 * kLongest && proved_zero(partial(*F, z) - e)) return F;
    return std::nullopt;
  };
  if (const std::optional<Expr> F = checked(e)) return F;
  const std::optional<Expr> full = expanded(e);
  if (full && !(*full == e)) return checked(*full);
  return std::nullopt;
}

std::optional<Expr> potential(const Column& form, const Column& z) {
  if (form.empty()) return std::nullopt;
  if (reachable(form).size() > kLongest) return std::nullopt;
  Expr f = form[0].graph->zero();
  for (std::size_t a = 0; a < z.size(); ++a) {
    const Expr left = form[a] - partial(f, z[a]);
    if (proved_zero(left)) continue;
    const std::optional<Expr> F = antiderivative(expanded(left).value_or(left), z[a]);
    if (!F) return std::nullopt;
    f += *F;
  }
  for (std::size_t a = 0; a < z.size(); ++a)
    if (!proved_zero(partial(f, z[a]) - form[a])) return std::nullopt;
  return f;
}

Expr exponential(Expr e) {
  Graph& g = *e.graph;
  const auto logarithm = [&](NodeId id) {
    return g.node(id).kind == Kind::function && static_cast<Function>(g.node(id).index) == Function::log;
  };
  if (logarithm(e.id)) return {&g, g.terms(e.id)[0].node};
  if (g.node(e.id).kind != Kind::sum) return exp(e);
  Expr powers = g.one(), rest = g.zero();
  for (const Term& t : g.terms(e.id)) {
    const Rational weight = g.rational(t.weight);
    if (logarithm(t.node))
      powers = powers * pow(Expr{&g, g.terms(t.node)[0].node}, weight);
    else
      rest += weight * Expr{&g, t.node};
  }
  return is_zero(rest) ? powers : powers * exp(rest);
}

}  // namespace anholon
