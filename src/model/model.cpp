#include "model/model.h"

namespace anholon {

Column put_controls(const Model& model, std::span<const Expr> es) {
  Graph& g = *model.graph;
  if (model.controls.empty()) return {es.begin(), es.end()};
  return substitute(es, [&](NodeId id) {
    const Node& n = g.node(id);
    if (n.kind != Kind::control) return Expr{};
    const Control& u = model.controls[n.index];
    if (u.constraint) return g.multiplier(static_cast<std::uint32_t>(*u.constraint), n.order);
    return u.value ? total_derivative(*u.value, n.order) : Expr{};
  });
}

Column put_masses(const Model& model, std::span<const Expr> es) {
  Graph& g = *model.graph;
  return put_controls(model, substitute(es, [&](NodeId id) {
                        const Node& n = g.node(id);
                        return n.kind == Kind::mass ? model.masses[n.index].value : Expr{};
                      }));
}

Expr put_state_rates(const Model& model, Expr e, unsigned from) {
  Graph& g = *model.graph;
  if (model.states.empty()) return e;
  // A rate may hold rates of other states; the reader has seen to it that this comes to an end.
  for (std::size_t depth = 0; depth <= model.states.size() * 4; ++depth) {
    bool any = false;
    e = substitute({&e, 1}, [&](NodeId id) {
      const Node n = g.node(id);
      if (n.kind != Kind::state || n.order < from) return Expr{};
      any = true;
      return total_derivative(model.states[n.index].rate, n.order - 1U);
    })[0];
    if (!any) break;
  }
  return e;
}

Expr put_masses(const Model& model, Expr e) { return put_masses(model, std::span<const Expr>(&e, 1))[0]; }

std::string multiplier_name(const Model& model, std::size_t r) {
  const Constraint& c = model.constraints[r];
  return c.by ? model.controls[*c.by].name : "lambda." + c.name;
}

Column jets(const Model& model, unsigned order) {
  Column q;
  for (std::size_t a = 0; a < model.coordinates.size(); ++a)
    q.push_back(model.graph->jet(static_cast<std::uint32_t>(a), order));
  return q;
}

}  // namespace anholon
