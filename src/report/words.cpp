#include "report/words.h"

#include <algorithm>

namespace anholon {

std::vector<std::string> effects(const Model& model) {
  std::vector<std::string> list;
  if (model.observer.inertial) list.push_back("the observer is inertial");
  if (!is_zero(model.observer.spin)) list.push_back("the observer turns (Coriolis, centrifugal and Euler forces)");
  if (!is_zero(model.observer.origin_acceleration)) list.push_back("the observer's origin accelerates");
  for (const VaryingMass& m : model.masses) {
    SymbolNames names = model.names;
    names.defined.erase(m.value.id);
    list.push_back("the " + std::string(m.weight ? "second moment" : "mass") + " of '" + m.name +
                   "' varies: " + print(m.value, names, Format::text));
  }
  for (const Dissipation& d : model.dissipation)
    list.push_back("dissipation '" + d.name + "': the forces -dR/dq' of R = " + d.formula);
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

std::vector<StateEntry> higher_state(const Scenario& s) {
  std::vector<StateEntry> list;
  for (std::size_t i = 0; i < s.state.states.size(); ++i)
    list.push_back({s.model->states[i].name, s.state.states[i], s.state.states_origin[i]});
  if (!s.routh) return list;
  for (int k = 0; k < *std::max_element(s.routh_structure.d.begin(), s.routh_structure.d.end()); ++k)
    for (std::size_t j = 0; j < s.routh->size(); ++j) {
      if (k >= s.routh_structure.d[j] || (j < s.routh->coordinates && k < 2)) continue;
      const Node n = s.routh->symbol_node(j, static_cast<unsigned>(k));
      if (n.kind == Kind::state) continue;
      list.push_back({derivative_name(s.routh->variable_names[j], static_cast<unsigned>(k), Format::text),
                      *s.state.value(n), *s.state.origin(n), n.kind == Kind::multiplier});
    }
  // States and coordinates first, by order.
  std::stable_partition(list.begin(), list.end(), [](const StateEntry& e) { return !e.multiplier; });
  return list;
}

std::string power_text(const Scenario& s, const ConstraintFacts& facts, std::size_t r) {
  const Expr factor = facts.power_factor;
  const Expr lambda = factor.graph->multiplier(static_cast<std::uint32_t>(r), 0);
  return print(lambda * factor, s.model->names, Format::text);
}

std::string description(const ConstraintClass& c, int order) {
  if (order == 0) return std::string(c.rheonomic ? "holonomic, rheonomic" : "holonomic");
  std::string s = "order " + std::to_string(order) + ", ";
  s += c.kind == "nonlinear" ? "nonlinear" : c.kind == "linear" ? "linear homogeneous" : "affine";
  if (c.kind == "nonlinear") s += c.homogeneous ? ", homogeneous" : ", not homogeneous";
  if (c.rheonomic) s += ", rheonomic";
  return s;
}

std::string work(const Scenario& s, const ConstraintFacts& facts, std::size_t r, std::size_t longest) {
  if (s.model->constraints[r].by) return "servo";
  if (is_zero(facts.power_factor)) return "does no work";
  const std::string power = power_text(s, facts, r);
  return power.size() > longest ? "may do work" : "may do work, of power " + power;
}

std::string listed(const Model& model, const std::vector<std::size_t>& constraints) {
  std::string list;
  for (std::size_t r : constraints) list += (list.empty() ? "" : ", ") + model.constraints[r].name;
  return list;
}

const char* in_words(Hypothesis hypothesis) {
  switch (hypothesis) {
  case Hypothesis::dalembert:
    return "ideal, no work in virtual displacements (d'Alembert, Lagrange)";
  case Hypothesis::chetaev:
    return "ideal by Chetaev's rule, along dphi/dq' (nonlinear in the velocities: a hypothesis)";
  case Hypothesis::niu:
    return "ideal in the sense of Chetaev and Niu, along dphi/dq^(m) (a postulate, not a theorem, for orders of 2 and "
           "more)";
  }
  return "";
}

}  // namespace anholon
