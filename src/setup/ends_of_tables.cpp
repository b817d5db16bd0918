#include "setup/ends_of_tables.h"

#include <set>
#include <unordered_map>

#include "expr/diff.h"

namespace anholon {

// Returns the expression with which a coefficient is replaced; a handle without a graph for other nodes. `bounds`: the
// expressions that are negative where a motion ends.
static Expr with_ends(Graph& g, NodeId id, const std::set<NodeId>& bounds, Expr x) {
  const Node n = g.node(id);
  const Expr given{&g, g.terms(id)[0].node};
  const std::vector<Rational> knots = g.step_function(n.index).knots;
  const Expr first = g.number(knots.front()), last = g.number(knots.back());
  const Expr above = given - first, below = last - given;
  if (!bounds.count(above.id) && !bounds.count(below.id)) return {};
  const Expr no = g.number(-1), below_last = select(last - x, g.one(), no), inside = select(x - first, below_last, no);
  const Expr value = g.lookup(n.index, x), end = g.apply(Function::log, inside);
  return value + end;
}

Column with_ends_of_tables(const Model& model, const Column& es) {
  std::set<NodeId> bounds;
  for (const Bound& b : model.bounds) bounds.insert(b.inside.id);
  std::unordered_map<NodeId, Expr> replacement;
  for (const NodeId id : bounds.empty() ? std::vector<NodeId>() : reachable(es)) {
    Graph& g = *model.graph;
    if (g.node(id).kind != Kind::lookup || g.step_function(g.node(id).index).power < 0) continue;
    const Expr argument{&g, g.terms(id)[0].node};
    if (const Expr e = with_ends(g, id, bounds, replace_nodes({&argument, 1}, replacement)[0]); e.graph)
      replacement.emplace(id, e);
  }
  return replacement.empty() ? es : replace_nodes(es, replacement);
}

void put_ends_of_tables(Workspace& s) {
  if (s.model->bounds.empty()) return;
  Column all;
  for_each_expression(s, [&](Expr& e) {
    if (e.graph) all.push_back(e);
  });
  const Column put = with_ends_of_tables(*s.model, all);
  std::size_t next = 0;
  for_each_expression(s, [&](Expr& e) {
    if (e.graph) e = put[next++];
  });
}

}  // namespace anholon
