#include "expr/derivatives/local_partials.h"

#include "expr/diff.h"

namespace anholon {

Expr derivative(Function f, [[maybe_unused]] Expr u, [[maybe_unused]] Expr v) {
  switch (f) {
#define ROW(name, formula, ...)                                                                                        \
  case Function::name:                                                                                                 \
    return formula;
#include "expr/elementary.def"
#undef ROW
  }
  return {};
}

void local_partials(Graph& g, NodeId id, std::vector<Expr>& out) {
  out.clear();
  const Node n = g.node(id);
  const std::vector<Term> terms(g.summands(id).begin(), g.summands(id).end());
  switch (n.kind) {
  case Kind::sum:
    for (const Term& t : terms) out.push_back(g.number(g.rational(t.weight)));
    return;
  case Kind::product:
    for (std::size_t i = 0; i < terms.size(); ++i) {
      std::vector<std::pair<Expr, Rational>> factors;
      const Rational exponent = g.rational(terms[i].weight);
      for (std::size_t j = 0; j < terms.size(); ++j) {
        const Rational& r = g.rational(terms[j].weight);
        factors.push_back({Expr{&g, terms[j].node}, j == i ? Rational(r - 1) : r});
      }
      out.push_back(exponent * g.product(factors));
    }
    return;
  case Kind::function:
    out.push_back(derivative(static_cast<Function>(n.index), Expr{&g, terms[0].node}, Expr{&g, id}));
    return;
  case Kind::atan2: {
    // Each node is made by a statement of its own: the order of terms is the order of their creation, which must not
    // depend on the compiler.
    const Expr y{&g, terms[0].node}, x{&g, terms[1].node}, y2 = y * y, x2 = x * x, r2 = x2 + y2;
    out.push_back(x / r2);
    out.push_back(-(y / r2));
    return;
  }
  case Kind::lookup:  // constant between its knots
    out.push_back(g.zero());
    return;
  case Kind::select: {
    const Expr s{&g, terms[0].node};
    out.push_back(g.zero());
    out.push_back(select(s, g.one(), g.zero()));
    out.push_back(select(s, g.zero(), g.one()));
    return;
  }
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
    return;
  }
}

}  // namespace anholon
