// The total derivative by one sweep over the graph.
#include <algorithm>
#include <unordered_set>

#include "expr/derivatives/local_partials.h"
#include "expr/diff.h"

namespace anholon {

static Expr rate_of_symbol(Graph& g, const Node& n) {
  switch (n.kind) {
  case Kind::time:
    return g.one();
  case Kind::jet:
    return g.jet(n.index, n.order + 1U);
  case Kind::multiplier:
    return g.multiplier(n.index, n.order + 1U);
  case Kind::given:
    return g.given(n.index, n.order + 1U);
  case Kind::quasi:
    return g.quasi(n.index, n.order + 1U);
  case Kind::state:
    return g.state(n.index, n.order + 1U);
  case Kind::control:
    return g.control(n.index, n.order + 1U);
  case Kind::number:
  case Kind::pi:
  case Kind::parameter:
  case Kind::mass:
  case Kind::sum:
  case Kind::product:
  case Kind::function:
  case Kind::atan2:
  case Kind::select:
  case Kind::lookup:
    return g.zero();
  }
  return g.zero();
}

// Returns the nodes of `es` and below whose rate is not known yet, operands before users.
static std::vector<NodeId> without_rate(Graph& g, std::span<const Expr> es) {
  std::vector<NodeId> found;
  std::unordered_set<NodeId> seen;
  const auto add = [&](NodeId id) {
    if (!g.rate(id).graph && seen.insert(id).second) found.push_back(id);
  };
  for (Expr e : es) add(e.id);
  for (std::size_t i = 0; i < found.size(); ++i)
    for (const Term& t : g.summands(found[i])) add(t.node);
  std::sort(found.begin(), found.end());
  return found;
}

Column total_derivative(std::span<const Expr> es) {
  if (es.empty()) return {};
  Graph& g = *es[0].graph;
  Column partials;
  for (NodeId id : without_rate(g, es)) {
    const Node n = g.node(id);
    if (n.view_count == 0) {
      g.set_rate(id, rate_of_symbol(g, n).id);
      continue;
    }
    const std::vector<Term> terms(g.summands(id).begin(), g.summands(id).end());
    std::vector<std::pair<Rational, Expr>> parts;
    const bool constant =
        std::all_of(terms.begin(), terms.end(), [&](const Term& t) { return is_zero(g.rate(t.node)); });
    if (constant) {
      g.set_rate(id, g.zero().id);
      continue;
    }
    if (n.kind == Kind::select) {
      // The rate is taken branch by branch: an expression must not be evaluated outside its own branch.
      g.set_rate(id, select(Expr{&g, terms[0].node}, g.rate(terms[1].node), g.rate(terms[2].node)).id);
      continue;
    }
    if (n.kind == Kind::sum) {
      for (const Term& t : terms) parts.push_back({g.rational(t.weight), g.rate(t.node)});
    } else {
      local_partials(g, id, partials);
      for (std::size_t i = 0; i < terms.size(); ++i)
        if (!is_zero(g.rate(terms[i].node))) parts.push_back({1, partials[i] * g.rate(terms[i].node)});
    }
    g.set_rate(id, g.sum(parts).id);
  }
  Column result;
  for (Expr e : es) result.push_back(g.rate(e.id));
  return result;
}

Expr total_derivative(Expr e) { return total_derivative(std::span<const Expr>(&e, 1))[0]; }

Expr total_derivative(Expr e, unsigned times) {
  for (; times > 0; --times) e = total_derivative(e);
  return e;
}

}  // namespace anholon
