#include "tape/point.h"

#include <algorithm>
#include <vector>

namespace anholon {

namespace {

template <Number N>
N apply(Function f, const N& u) {
  switch (f) {
#define ROW(name, derivative, parity, latex, domain) \
  case Function::name: return name(u);
#include "expr/elementary.def"
#undef ROW
  }
  return u;
}

}  // namespace

template <Number N>
N ValuesAt<N>::evaluate(const Graph& g, NodeId id) const {
  const Node& n = g.node(id);
  switch (n.kind) {
    case Kind::number: return from_rational<N>(g.value(id));
    case Kind::pi: return pi<N>();
    case Kind::sum: {
      N s(0);
      for (const Term& t : g.summands(id)) s += from_rational<N>(g.rational(t.weight)) * known_.at(t.node);
      return s;
    }
    case Kind::product: {
      N p(1);
      for (const Term& t : g.terms(id)) p *= pow(known_.at(t.node), from_rational<N>(g.rational(t.weight)));
      return p;
    }
    case Kind::function: return apply(static_cast<Function>(n.index), known_.at(g.terms(id)[0].node));
    case Kind::atan2: return atan2(known_.at(g.terms(id)[0].node), known_.at(g.terms(id)[1].node));
    case Kind::time: case Kind::jet: case Kind::parameter: case Kind::mass: case Kind::multiplier: case Kind::given:
    case Kind::quasi: case Kind::state: case Kind::control:
      return symbol_(n);
    case Kind::select: return known_.at(g.terms(id)[!(known_.at(g.terms(id)[0].node) < N(0)) ? 1 : 2].node);
    case Kind::lookup: {
      const StepFunction& f = g.step_function(n.index);
      const N& x = known_.at(g.terms(id)[0].node);
      std::size_t k = 0;
      while (k < f.knots.size() && !(x < from_rational<N>(f.knots[k]))) ++k;
      return from_rational<N>(f.values[k]);
    }
  }
  return N(0);
}

template <Number N>
N ValuesAt<N>::operator()(Expr e) {
  const Graph& g = *e.graph;
  std::vector<NodeId> open = {e.id}, found;
  while (!open.empty()) {
    const NodeId id = open.back();
    open.pop_back();
    if (!known_.try_emplace(id, N(0)).second) continue;
    found.push_back(id);
    for (const Term& t : g.summands(id)) open.push_back(t.node);
  }
  std::sort(found.begin(), found.end());
  for (NodeId id : found) known_.insert_or_assign(id, evaluate(g, id));
  return known_.at(e.id);
}

template class ValuesAt<double>;
template class ValuesAt<Multi>;

}  // namespace anholon
