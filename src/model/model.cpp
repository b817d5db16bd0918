#include "model/model.h"

#include <algorithm>

namespace anholon {

// Puts the multipliers of constraints in place of the inputs that keep them.
static Column put_servo_inputs(const Model& model, std::span<const Expr> es) {
  Graph& g = *model.graph;
  return substitute(es, [&](NodeId id) {
    const Node& n = g.node(id);
    if (n.kind != Kind::control) return Expr{};
    const std::optional<std::size_t> constraint = model.controls[n.index].constraint;
    return constraint ? g.multiplier(static_cast<std::uint32_t>(*constraint), n.order) : Expr{};
  });
}

// The formula of an input may hold inputs that keep constraints.
Column put_controls(const Model& model, std::span<const Expr> es) {
  const Graph& g = *model.graph;
  if (model.controls.empty()) return {es.begin(), es.end()};
  const Column put = substitute(es, [&](NodeId id) {
    const Node n = g.node(id);
    if (n.kind != Kind::control) return Expr{};
    const Control& u = model.controls[n.index];
    return u.value ? total_derivative(*u.value, n.order) : Expr{};
  });
  return put_servo_inputs(model, put);
}

Column put_varying_masses(const Model& model, std::span<const Expr> es) {
  const Graph& g = *model.graph;
  return substitute(es, [&](NodeId id) {
    const Node& n = g.node(id);
    return n.kind == Kind::mass ? model.masses[n.index].value : Expr{};
  });
}

Column put_masses(const Model& model, std::span<const Expr> es) {
  return put_controls(model, put_varying_masses(model, es));
}

Expr open_form(const Model& model, Expr as_read) {
  for (const NodeId id : symbols({&as_read, 1}))
    if (const Node& n = as_read.graph->node(id); n.kind == Kind::control && model.controls[n.index].value)
      return as_read;
  return {};
}

void put_inputs(Model& model) {
  const auto put = [&](Expr& value, Expr open) {
    if (open.graph) value = put_masses(model, open);
  };
  for (Monitor& m : model.monitors) put(m.value, m.open);
  for (StateVariable& z : model.states) put(z.rate, z.open_rate);
  for (Event& e : model.events) {
    put(e.when, e.open_when);
    for (Assignment& a : e.set) put(a.value, a.open);
  }
}

void put_inputs_into_inputs(Model& model, const std::set<std::size_t>& given) {
  for (std::size_t k = 0; k < model.controls.size(); ++k)
    if (Control& u = model.controls[k]; u.open.graph && !given.count(k)) u.value = u.open;
  // The reader has checked that inputs do not depend on each other in a circle.
  for (std::size_t depth = 0; depth < model.controls.size(); ++depth)
    for (std::size_t k = 0; k < model.controls.size(); ++k)
      if (Control& u = model.controls[k]; u.open.graph && u.value && !given.count(k))
        u.value = put_controls(model, {&*u.value, 1})[0];
}

Expr put_state_rates(const Model& model, Expr e, unsigned from) {
  Graph& g = *model.graph;
  if (model.states.empty()) return e;
  // A rate may contain rates of other states; the reader has checked that they do not depend on each other in a circle.
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

std::string automatic_name(const Model& model, const std::string& wanted) {
  const auto named = [&](const std::string& name) {
    const auto among = [&](const std::vector<std::string>& list) {
      return std::find(list.begin(), list.end(), name) != list.end();
    };
    const SymbolNames& n = model.names;
    return among(n.coordinates) || among(n.parameters) || among(n.given) || among(n.states) || among(n.controls) ||
           std::any_of(n.defined.begin(), n.defined.end(), [&](const auto& d) { return d.second == name; }) ||
           std::any_of(model.quasi.begin(), model.quasi.end(), [&](const QuasiVelocity& u) { return u.name == name; });
  };
  // Names with a number must also differ from the names of other masses and velocities.
  const auto wanted_by_others = [&](const std::string& name) {
    return std::any_of(model.masses.begin(), model.masses.end(),
                       [&](const VaryingMass& m) { return name == "m_" + m.name; }) ||
           std::any_of(model.coordinates.begin(), model.coordinates.end(),
                       [&](const Coordinate& c) { return name == "u_" + c.name; });
  };
  if (!named(wanted)) return wanted;
  for (int k = 2;; ++k)
    if (const std::string name = wanted + "_" + std::to_string(k); !named(name) && !wanted_by_others(name)) return name;
}

std::string mass_name(const Model& model, std::size_t i) {
  std::string of = model.masses[i].name;  // "wheel weight x" for a second moment
  std::replace(of.begin(), of.end(), ' ', '_');
  return automatic_name(model, "m_" + of);
}

Column jets(const Model& model, unsigned order) {
  Column q;
  for (std::size_t a = 0; a < model.coordinates.size(); ++a)
    q.push_back(model.graph->jet(static_cast<std::uint32_t>(a), order));
  return q;
}

}  // namespace anholon
