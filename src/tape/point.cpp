#include "tape/point.h"

#include <algorithm>
#include <vector>

#include "numeric/number.h"

namespace anholon {

namespace {

double apply(Function f, double u) {
  switch (f) {
#define ROW(name, derivative, parity, latex, domain) \
  case Function::name: return name(u);
#include "expr/elementary.def"
#undef ROW
  }
  return u;
}

}  // namespace

double PointValues::evaluate(const Graph& g, NodeId id) const {
  const Node& n = g.node(id);
  switch (n.kind) {
    case Kind::number: return from_rational<double>(g.value(id));
    case Kind::pi: return pi<double>();
    case Kind::sum: {
      double s = 0;
      for (const Term& t : g.summands(id)) s += from_rational<double>(g.rational(t.weight)) * known_.at(t.node);
      return s;
    }
    case Kind::product: {
      double p = 1;
      for (const Term& t : g.terms(id)) p *= std::pow(known_.at(t.node), from_rational<double>(g.rational(t.weight)));
      return p;
    }
    case Kind::function: return apply(static_cast<Function>(n.index), known_.at(g.terms(id)[0].node));
    case Kind::atan2: return std::atan2(known_.at(g.terms(id)[0].node), known_.at(g.terms(id)[1].node));
    case Kind::time: case Kind::jet: case Kind::parameter: case Kind::mass: case Kind::multiplier: case Kind::given:
    case Kind::quasi:
      return symbol_(n);
  }
  return 0;
}

double PointValues::operator()(Expr e) {
  const Graph& g = *e.graph;
  std::vector<NodeId> open = {e.id}, found;
  while (!open.empty()) {
    const NodeId id = open.back();
    open.pop_back();
    if (!known_.try_emplace(id, 0.0).second) continue;
    found.push_back(id);
    for (const Term& t : g.summands(id)) open.push_back(t.node);
  }
  std::sort(found.begin(), found.end());
  for (NodeId id : found) known_[id] = evaluate(g, id);
  return known_[e.id];
}

}  // namespace anholon
