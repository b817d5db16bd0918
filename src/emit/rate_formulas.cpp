#include "emit/rate_formulas.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>

#include "tape/point.h"

namespace anholon {

namespace {

bool varies(Expr e) {
  const std::vector<NodeId> list = symbols({&e, 1});
  return std::any_of(list.begin(), list.end(), [&](NodeId id) { return e.graph->node(id).kind != Kind::parameter; });
}

// Returns a number at which a function that is not defined everywhere has a value: 1/2 or 2.
Rational defined_at(Function f, Graph& g) {
  PointValues at([](const Node&) { return 0.0; });
  return std::isfinite(at(g.apply(f, g.number({1, 2})))) ? Rational(1, 2) : Rational(2);
}

// Returns the parts of a branch that may have no value, each with a number at which it has one: radicands, divisors and
// arguments.
std::unordered_map<NodeId, Rational> risks(Expr branch) {
  std::unordered_map<NodeId, Rational> list;
  const Graph& g = *branch.graph;
  const auto add = [&](NodeId id, const Rational& safe) {
    if (!g.is_number(id) && varies({branch.graph, id})) list.emplace(id, safe);
  };
  for (const NodeId id : reachable({&branch, 1})) {
    const Node n = g.node(id);
    if (n.kind == Kind::product)
      for (const Term& t : g.terms(id))
        if (const Rational& e = g.rational(t.weight); !e.is_integer() || e < 0) add(t.node, 1);
    if (n.kind != Kind::function) continue;
    const NodeId argument = g.terms(id)[0].node;
    const Function f = static_cast<Function>(n.index);
    if (*info(f).undefined) add(argument, defined_at(f, *branch.graph));
  }
  return list;
}

// True for a formula with a root, or with a function that is not defined everywhere, of what varies.
bool may_lack_value(const Column& es) {
  for (const NodeId id : reachable(es)) {
    const Graph& g = *es[0].graph;
    const Node& n = g.node(id);
    if (n.kind == Kind::function && *info(static_cast<Function>(n.index)).undefined) return true;
    if (n.kind != Kind::product) continue;
    for (const Term& t : g.terms(id))
      if (!g.rational(t.weight).is_integer() && varies({es[0].graph, t.node})) return true;
  }
  return false;
}

}  // namespace

Column with_guarded_branches(const Column& es) {
  if (es.empty()) return es;
  Graph& g = *es[0].graph;
  std::unordered_map<NodeId, Expr> guarded;
  for (const NodeId id : reachable(es)) {
    if (g.node(id).kind != Kind::select) continue;
    std::vector<Expr> parts;  // the condition, and both values
    for (const Term& t : g.terms(id)) parts.push_back({&g, t.node});
    parts = replace_nodes(parts, guarded);
    for (const std::size_t k : {1U, 2U}) {
      std::unordered_map<NodeId, Expr> safe;
      for (const auto& [node, number] : risks(parts[k])) {
        const Expr e{&g, node}, otherwise = g.number(number);
        safe.emplace(node, k == 1 ? select(parts[0], e, otherwise) : select(parts[0], otherwise, e));
      }
      if (!safe.empty()) parts[k] = replace_nodes({&parts[k], 1}, safe)[0];
    }
    guarded.emplace(id, select(parts[0], parts[1], parts[2]));
  }
  return guarded.empty() ? es : replace_nodes(es, guarded);
}

std::vector<Column> RateFormulas::matrix() const {
  std::vector<Column> rows;
  for (Expr e : equations) rows.push_back(gradient(e, lead.symbols));
  return rows;
}

Column RateFormulas::right() const {
  if (!linear) return -equations;
  Graph& g = *model->graph;
  return -substitute(equations, [&](NodeId id) {
    for (Expr s : lead.symbols)
      if (s.id == id) return g.zero();
    return Expr{};
  });
}

std::vector<std::size_t> RateFormulas::rows_that_may_lack_values() const {
  const bool in_equations = !equations.empty() && may_lack_value(equations);
  std::set<NodeId> unknowns;
  for (Expr e : lead.symbols) unknowns.insert(e.id);
  std::vector<std::size_t> rows;
  std::size_t row = 0;
  for (const Column* es : {&rates, &outputs})
    for (Expr e : *es) {
      const std::vector<NodeId> in = symbols({&e, 1});
      const bool solved = std::any_of(in.begin(), in.end(), [&](NodeId id) { return unknowns.count(id) > 0; });
      if ((solved && in_equations) || may_lack_value({e})) rows.push_back(row);
      ++row;
    }
  return rows;
}

}  // namespace anholon
