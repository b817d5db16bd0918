#include "model/model.h"

namespace anholon {

Column put_masses(const Model& model, std::span<const Expr> es) {
  Graph& g = *model.graph;
  return substitute(es, [&](NodeId id) {
    const Node& n = g.node(id);
    return n.kind == Kind::mass ? model.masses[n.index].value : Expr{};
  });
}

Expr put_masses(const Model& model, Expr e) { return put_masses(model, std::span<const Expr>(&e, 1))[0]; }

Column jets(const Model& model, unsigned order) {
  Column q;
  for (std::size_t a = 0; a < model.coordinates.size(); ++a)
    q.push_back(model.graph->jet(static_cast<std::uint32_t>(a), order));
  return q;
}

}  // namespace anholon
