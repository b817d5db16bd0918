#include "model/model.h"

namespace anholon {

const std::vector<std::string>& integrator_names() {
  static const std::vector<std::string> names = {"taylor", "cvode", "ida"};  // in the order of Integrator
  return names;
}

const char* name(Integrator integrator) { return integrator_names()[static_cast<std::size_t>(integrator)].c_str(); }

std::optional<Integrator> find_integrator(const std::string& name) {
  const std::vector<std::string>& names = integrator_names();
  for (std::size_t k = 0; k < names.size(); ++k)
    if (names[k] == name) return static_cast<Integrator>(k);
  return std::nullopt;
}

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
