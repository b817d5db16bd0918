#include "cli/check_report.h"

#include <algorithm>

namespace anholon::cli {

std::vector<std::string> effects(const Model& model) {
  std::vector<std::string> list;
  if (model.observer.inertial) list.push_back("the observer is inertial");
  if (!is_zero(model.observer.spin)) list.push_back("the observer turns (Coriolis, centrifugal and Euler forces)");
  if (!is_zero(model.observer.origin_acceleration)) list.push_back("the observer's origin accelerates");
  for (const VaryingMass& m : model.masses)
  {
    SymbolNames names = model.names;
    names.defined.erase(m.value.id);
    list.push_back("the " + std::string(m.weight ? "second moment" : "mass") + " of '" + m.name + "' varies: " + print(m.value, names, Format::text));
  }
  for (const Dissipation& d : model.dissipation) list.push_back("dissipation '" + d.name + "': the forces -dR/dq' of R = " + d.formula);
  for (const Body& b : model.bodies)
    if (!b.gravity_gradient.empty()) list.push_back("gravity turns '" + b.name + "': its field varies over the body");
  for (const Body& b : model.bodies)
    if (b.expelled_velocity) list.push_back("'" + b.name + "' expels or collects matter");
  return list;
}

std::vector<std::string> external_forces(const Model& model) {
  std::vector<std::string> list;
  for (const Force& f : model.forces)
    if (!f.from && f.kind != Force::Kind::generalized)
      list.push_back("'" + f.name + "' on '" + model.bodies[f.on.body].name + "'");
  return list;
}

std::vector<Entry> higher_state(const Scenario& s) {
  std::vector<Entry> list;
  if (!s.routh) return list;
  const Graph& g = *s.model->graph;
  for (int k = 0; k < *std::max_element(s.routh_structure.d.begin(), s.routh_structure.d.end()); ++k)
    for (std::size_t j = 0; j < s.routh->size(); ++j) {
      if (k >= s.routh_structure.d[j] || (j < s.routh->coordinates && k < 2)) continue;
      const Node& n = g.node(s.routh->symbol(j, static_cast<unsigned>(k)).id);
      list.push_back({derivative_name(s.routh->variable_names[j], static_cast<unsigned>(k), Format::text), *s.state.value(n), *s.state.origin(n)});
    }
  // Coordinates first, by order.
  std::stable_partition(list.begin(), list.end(), [](const Entry& e) { return e.name.rfind("lambda.", 0) != 0; });
  return list;
}

std::string power_text(const Scenario& s, const Explanation& x, std::size_t r) {
  return print(s.mechanics->lambda[r] * x.constraints[r].power_factor, s.model->names, Format::text);
}

}  // namespace anholon::cli
