#include "system/system.h"

#include <algorithm>

namespace anholon {

Expr System::symbol(std::size_t j, unsigned k) const {
  Graph& g = *model->graph;
  if (j < coordinates) return g.jet(static_cast<std::uint32_t>(j), k);
  return g.multiplier(static_cast<std::uint32_t>(constraints[j - coordinates]), k);
}

std::optional<std::size_t> System::variable(NodeId symbol) const {
  const Node& n = model->graph->node(symbol);
  if (n.kind == Kind::jet) return n.index;
  if (n.kind != Kind::multiplier) return std::nullopt;
  const auto it = std::find(constraints.begin(), constraints.end(), n.index);
  if (it == constraints.end()) return std::nullopt;
  return coordinates + static_cast<std::size_t>(it - constraints.begin());
}

System implicit_system(std::shared_ptr<const Model> model, const Mechanics& m, const Formulation& form,
                       const std::vector<std::size_t>& constraints) {
  System s;
  Graph& g = *model->graph;
  s.model = model;
  s.form = &form;
  s.coordinates = model->coordinates.size();
  s.constraints = constraints;
  const Equations e = form.equations(m);
  s.equations = put_masses(*model, e.left - e.right);
  for (const Coordinate& c : model->coordinates) {
    s.equation_names.push_back(c.name);
    s.variable_names.push_back(c.name);
  }
  for (std::size_t r : constraints) {
    s.equations.push_back(put_masses(*model, m.phi[r]));
    s.equation_names.push_back(model->constraints[r].name);
    s.variable_names.push_back("lambda." + model->constraints[r].name);
  }
  if (constraints.size() < model->constraints.size())
    s.equations = substitute(s.equations, [&](NodeId id) {
      const Node& n = g.node(id);
      const bool out = n.kind == Kind::multiplier &&
                       std::find(constraints.begin(), constraints.end(), n.index) == constraints.end();
      return out ? g.zero() : Expr{};
    });
  return s;
}

}  // namespace anholon
