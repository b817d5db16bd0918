#include "system/system.h"

#include <algorithm>

namespace anholon {

Expr System::symbol(std::size_t j, unsigned k) const {
  Graph& g = *model->graph;
  if (j < coordinates) return g.jet(static_cast<std::uint32_t>(j), k);
  if (j >= mechanical()) return g.state(static_cast<std::uint32_t>(j - mechanical()), k);
  return g.multiplier(static_cast<std::uint32_t>(constraints[j - coordinates]), k);
}

Node System::symbol_node(std::size_t j, unsigned k) const {
  const auto node = [&](Kind kind, std::size_t index) {
    return Node{kind, static_cast<std::uint8_t>(k), static_cast<std::uint32_t>(index)};
  };
  if (j < coordinates) return node(Kind::jet, j);
  if (j >= mechanical()) return node(Kind::state, j - mechanical());
  return node(Kind::multiplier, constraints[j - coordinates]);
}

std::optional<std::size_t> System::variable(NodeId symbol) const {
  const Node& n = model->graph->node(symbol);
  if (n.kind == Kind::jet) return n.index < coordinates ? std::optional<std::size_t>(n.index) : std::nullopt;
  if (n.kind == Kind::state) return mechanical() + n.index;
  if (n.kind != Kind::multiplier) return std::nullopt;
  const auto it = std::find(constraints.begin(), constraints.end(), n.index);
  if (it == constraints.end()) return std::nullopt;
  return coordinates + static_cast<std::size_t>(it - constraints.begin());
}

// Sets the equations of motion with their names: those of the form, then those of the multipliers.
static void equations_of_motion(System& s, const Mechanics& m, const Elimination& e) {
  const Equations form = s.form->equations(m, e);
  Column residual = form.left - form.right;
  if (!s.form->eliminates()) {
    s.equations = put_masses(*s.model, residual);
    s.of_motion = s.equations.size();
    for (const Coordinate& c : s.model->coordinates) s.equation_names.push_back(c.name);
    return;
  }
  // If a form has n equations without multipliers, their components along the constraints count; across them the
  // constraints themselves hold.
  if (residual.size() == m.q.size() && !e.constraints.empty()) residual = e.contract(residual);
  s.equations = put_masses(*s.model, e.in_coordinates(residual));
  s.of_motion = s.equations.size();
  s.equation_names = e.free.names;
  const Column a = put_masses(*s.model, e.D(lagrange_operator(m) - right_side(m)));
  for (std::size_t b = 0; b < a.size(); ++b) {
    s.equations.push_back(a[b]);
    s.equation_names.push_back(s.model->coordinates[e.dependent[b]].name);
  }
}

// True if derivatives of states beyond their rates may occur: equations of motion contain them, or are differentiated
// for constraints of order 3 and more and for those that an input enforces.
static bool goes_beyond_rates(const System& s, const Mechanics& m) {
  const Graph& g = *s.model->graph;
  const std::vector<Constraint>& list = s.model->constraints;
  const std::vector<NodeId> met = symbols(s.equations);
  return std::any_of(m.order.begin(), m.order.end(), [](int order) { return order > 2; }) ||
         std::any_of(list.begin(), list.end(), [](const Constraint& c) { return c.by.has_value(); }) ||
         std::any_of(met.begin(), met.end(),
                     [&](NodeId id) { return g.node(id).kind == Kind::state && g.node(id).order > 1; });
}

System implicit_system(std::shared_ptr<const Model> model, const Mechanics& m, const Formulation& form,
                       const std::vector<std::size_t>& constraints, const Elimination& elimination) {
  System s;
  Graph& g = *model->graph;
  s.model = model;
  s.form = &form;
  s.coordinates = model->coordinates.size();
  s.constraints = constraints;
  equations_of_motion(s, m, elimination);
  // The start and the motion hold no derivative of a state beyond its rate, so the formula of the rate is substituted.
  if (goes_beyond_rates(s, m))
    for (Expr& e : s.equations) e = put_state_rates(*model, e, 1);
  for (const Coordinate& c : model->coordinates) s.variable_names.push_back(c.name);
  for (std::size_t r : constraints) {
    s.equations.push_back(put_masses(*model, m.phi[r]));
    s.equation_names.push_back(model->constraints[r].name);
    s.variable_names.push_back(multiplier_name(*model, r));
  }
  for (std::size_t i = 0; i < model->states.size(); ++i) {
    const StateVariable& z = model->states[i];
    const Expr rate = g.state(static_cast<std::uint32_t>(i), 1);
    s.equations.push_back(rate - put_masses(*model, z.rate));
    s.equation_names.push_back(z.name);
    s.variable_names.push_back(z.name);
  }
  if (constraints.size() < model->constraints.size()) s.equations = taking_part(s, s.equations);
  if (model->scales.size() == s.coordinates + model->states.size()) {
    s.scales = model->scales;
    s.scales.insert(s.scales.begin() + static_cast<std::ptrdiff_t>(s.coordinates), constraints.size(), 0);
  }
  return s;
}

Column taking_part(const System& s, const Column& es) {
  Graph& g = *s.model->graph;
  return substitute(
      es, [&](NodeId id) { return g.node(id).kind == Kind::multiplier && !s.variable(id) ? g.zero() : Expr{}; });
}

void for_each_expression(System& s, const ExprVisitor& f) {
  auto& [model, form, coordinates, constraints, equations, of_motion, equation_names, variable_names, scales, rates] =
      s;
  static_cast<void>(model), static_cast<void>(form);
  for_each_expression_of(f, coordinates, constraints, equations, of_motion, equation_names, variable_names, scales,
                         rates);
}

}  // namespace anholon
