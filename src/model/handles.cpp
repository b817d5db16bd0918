// The handles of a model, type by type, and its copies.
#include "model/model.h"

namespace anholon {

// SymbolNames refer to nodes by their ids, which are the same in a clone of the graph.
template <>
inline constexpr bool kHoldsNoExpressions<SymbolNames> = true;
template <>
inline constexpr bool kHoldsNoExpressions<MotionSettings> = true;
template <>
inline constexpr bool kHoldsNoExpressions<ModelNote> = true;

static void for_each_expression(Coordinate& c, const ExprVisitor& f) {
  auto& [name, span] = c;
  for_each_expression_of(f, name, span);
}

static void for_each_expression(Parameter& p, const ExprVisitor& f) {
  auto& [name, value, doc, span, mode, is_vector, unit] = p;
  for_each_expression_of(f, name, value, doc, span, mode, is_vector, unit);
}

static void for_each_expression(Observer& o, const ExprVisitor& f) {
  auto& [spin, origin_acceleration, origin_velocity, inertial] = o;
  for_each_expression_of(f, spin, origin_acceleration, origin_velocity, inertial);
}

static void for_each_expression(VaryingMass& m, const ExprVisitor& f) {
  auto& [name, weight, value, span] = m;
  for_each_expression_of(f, name, weight, value, span);
}

static void for_each_expression(Axis& a, const ExprVisitor& f) {
  auto& [weight, vector, own] = a;
  for_each_expression_of(f, weight, vector, own);
}

static void for_each_expression(Shape& s, const ExprVisitor& f) {
  auto& [kind, sizes] = s;
  for_each_expression_of(f, kind, sizes);
}

static void for_each_expression(Body& b, const ExprVisitor& f) {
  auto& [name, span, particle, mass, center, orientation, axes, expelled_velocity, exit_point, gravity,
         gravity_gradient, shape] = b;
  for_each_expression_of(f, name, span, particle, mass, center, orientation, axes, expelled_velocity, exit_point,
                         gravity, gravity_gradient, shape);
}

static void for_each_expression(Force::Place& p, const ExprVisitor& f) {
  auto& [body, point, at_center] = p;
  for_each_expression_of(f, body, point, at_center);
}

static void for_each_expression(Force& force, const ExprVisitor& f) {
  auto& [name, span, kind, on, from, vector, tension, generalized] = force;
  for_each_expression_of(f, name, span, kind, on, from, vector, tension, generalized);
}

static void for_each_expression(Potential& p, const ExprVisitor& f) {
  auto& [name, value, span] = p;
  for_each_expression_of(f, name, value, span);
}

static void for_each_expression(Dissipation& d, const ExprVisitor& f) {
  auto& [name, value, formula, span] = d;
  for_each_expression_of(f, name, value, formula, span);
}

static void for_each_expression(Constraint& c, const ExprVisitor& f) {
  auto& [name, phi, order, equation, span, by] = c;
  for_each_expression_of(f, name, phi, order, equation, span, by);
}

static void for_each_expression(StateVariable& z, const ExprVisitor& f) {
  auto& [name, rate, initial, span, open_rate] = z;
  for_each_expression_of(f, name, rate, initial, span, open_rate);
}

static void for_each_expression(Control& u, const ExprVisitor& f) {
  auto& [name, value, constraint, span, open, put_into] = u;
  for_each_expression_of(f, name, value, constraint, span, open, put_into);
}

static void for_each_expression(OutputQuantity& o, const ExprVisitor& f) {
  auto& [name, unit, doc, values, conserved, span] = o;
  for_each_expression_of(f, name, unit, doc, values, conserved, span);
}

static void for_each_expression(Assignment& a, const ExprVisitor& f) {
  auto& [symbol, value, span, open] = a;
  for_each_expression_of(f, symbol, value, span, open);
}

static void for_each_expression(Event& e, const ExprVisitor& f) {
  auto& [name, when, direction, set, stop, span, open_when] = e;
  for_each_expression_of(f, name, when, direction, set, stop, span, open_when);
}

void for_each_expression(QuasiVelocity& u, const ExprVisitor& f) {
  auto& [name, value, order, span] = u;
  for_each_expression_of(f, name, value, order, span);
}

static void for_each_expression(Monitor& m, const ExprVisitor& f) {
  auto& [name, value, span, open] = m;
  for_each_expression_of(f, name, value, span, open);
}

static void for_each_expression(Bound& b, const ExprVisitor& f) {
  auto& [inside, fault, span] = b;
  for_each_expression_of(f, inside, fault, span);
}

static void for_each_expression(GivenValue& v, const ExprVisitor& f) {
  auto& [symbol, value, span] = v;
  for_each_expression_of(f, symbol, value, span);
}

static void for_each_expression(Condition& c, const ExprVisitor& f) {
  auto& [residual, text, span] = c;
  for_each_expression_of(f, residual, text, span);
}

static void for_each_expression(BranchChoice& b, const ExprVisitor& f) {
  auto& [constraint, positive, span] = b;
  for_each_expression_of(f, constraint, positive, span);
}

static void for_each_expression(InitialData& d, const ExprVisitor& f) {
  auto& [t, given, guess, conditions, branches] = d;
  for_each_expression_of(f, t, given, guess, conditions, branches);
}

static void for_each_expression(View::Element& e, const ExprVisitor& f) {
  auto& [name, kind, color, shape, places, axes, vector, span] = e;
  for_each_expression_of(f, name, kind, color, shape, places, axes, vector, span);
}

static void for_each_expression(View& v, const ExprVisitor& f) {
  auto& [elements, points, camera, target, up, floor, no_floor, follow, hidden] = v;
  for_each_expression_of(f, elements, points, camera, target, up, floor, no_floor, follow, hidden);
}

void for_each_expression(Model& model, const ExprVisitor& f) {
  auto& [graph, source_text, title, source, coordinates, parameters, unknown_functions, table_files, observer, masses,
         bodies, forces, potentials, dissipation, constraints, quasi, dependent, initial, states, controls, outputs,
         events, bounds, monitors, simulate, view, names, cases, coordinate_units, parameter_units, scales, notes] =
      model;
  static_cast<void>(graph);
  for_each_expression_of(f, source_text, title, source, coordinates, parameters, unknown_functions, table_files,
                         observer, masses, bodies, forces, potentials, dissipation, constraints, quasi, dependent,
                         initial, states, controls, outputs, events, bounds, monitors, simulate, view, names, cases,
                         coordinate_units, parameter_units, scales, notes);
}

std::shared_ptr<Model> clone(const Model& model, std::size_t nodes) {
  auto copy = std::make_shared<Model>(model);
  copy->graph = model.graph->clone(nodes);
  for_each_expression(*copy, [&](Expr& e) {
    if (e.graph) e = copy->graph->own(e);
  });
  return copy;
}

std::shared_ptr<Model> clone(const Model& model) { return clone(model, model.graph->size()); }

}  // namespace anholon
