#include "modelfile/mechanical/gaps.h"

#include <algorithm>
#include <unordered_map>

namespace anholon {

bool touches_zero_only(Expr e) {
  const Graph& g = *e.graph;
  std::unordered_map<NodeId, bool> known;
  for (const NodeId id : reachable({&e, 1})) {
    const Node& n = g.node(id);
    const std::span<const Term> terms = g.terms(id);
    bool never_negative = n.kind == Kind::function && static_cast<Function>(n.index) == Function::abs;
    if (n.kind == Kind::product)
      never_negative = std::all_of(terms.begin(), terms.end(), [&](const Term& t) {
        const Rational &power = g.rational(t.weight), half = power / 2;
        return power > 0 && (half.is_integer() || known[t.node]);
      });
    if (n.kind == Kind::sum)
      never_negative = std::all_of(terms.begin(), terms.end(), [&](const Term& t) {
        return g.rational(t.weight) > 0 && !g.is_number(t.node) && known[t.node];
      });
    known[id] = never_negative;
  }
  return known[e.id];
}

}  // namespace anholon
