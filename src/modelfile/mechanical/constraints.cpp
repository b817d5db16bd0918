#include "modelfile/mechanical/constraints.h"

#include <algorithm>

#include "expr/normal.h"
#include "formula/indices.h"
#include "modelfile/mechanical/contacts.h"
#include "modelfile/mechanical/control.h"
#include "modelfile/names/along.h"
#include "modelfile/text/collect.h"
#include "modelfile/text/keys.h"
#include "tape/tape.h"

namespace anholon {

// Returns the highest order of derivative on which phi depends after simplification.
int ConstraintReader::true_order(Expr& phi) const {
  Graph& g = *model_.graph;
  for (int k = jet_order(phi);; --k) {
    if (k < 0) return k;
    Column top;
    for (NodeId id : symbols({&phi, 1}))
      if (g.node(id).kind == Kind::jet && g.node(id).order == k) top.push_back({&g, id});
    const Column d = gradient(phi, top);
    const auto told = [](Expr e) { return is_number(e) && !is_zero(e); };  // a nonzero number, which needs no proof
    const bool depends = std::any_of(d.begin(), d.end(), told) ||
                         std::any_of(d.rbegin(), d.rend(), [](Expr e) { return !proved_zero(e); });
    if (depends) return k;
    phi = substitute({&phi, 1}, [&](NodeId id) {
      const Node& n = g.node(id);
      // Any value serves, because phi does not depend on the symbol; zero could occur in a denominator.
      return n.kind == Kind::jet && n.order == k ? g.number(Rational(17, 13)) : Expr{};
    })[0];
  }
}

void ConstraintReader::add_constraint(const std::string& name, Expr phi, const std::string& equation, Span place,
                                      std::optional<Span> named) {
  phi = with_feedback(model_, phi, "the constraint '" + name + "'");
  const int order = true_order(phi);
  if (order < 0) {
    if (proved_zero(phi)) throw Failure(place, "this equation always holds: it constrains nothing");
    if (const auto constant = expanded(phi); constant && is_number(*constant))
      throw Failure(place, "this equation never holds: its sides differ by " +
                               to_string(Rational(abs(number_value(*constant)))));
    throw Failure(place, "no coordinate or derivative occurs in this equation",
                  "a constraint relates coordinates and their derivatives");
  }
  if (model_.constraints.size() + model_.coordinates.size() >= kMostUnknowns)
    throw Failure(place,
                  "the constraints and coordinates are more than " + std::to_string(kMostUnknowns) + " together");
  if (!names_.insert(name).second)
    throw Failure(named ? *named : place, "there are two constraints '" + name + "'", "give one of them another name");
  model_.constraints.push_back({name, phi, order, equation, place});
  model_.names.multipliers.push_back(name);
}

// Adds the unit norms that quaternions need.
std::vector<UnitNorm> ConstraintReader::norms_of_quaternions() {
  std::vector<UnitNorm> norms;
  collect(diagnostics_, [&] { norms = unit_norms(scope_, model_); });
  for (const UnitNorm& n : norms)
    collect(diagnostics_, [&] {
      add_constraint(n.name, n.phi, n.equation, n.span);
      model_.notes.push_back("constraint '" + n.name + "' is added: " + n.equation +
                             ", without which quat(…) in line " + std::to_string(n.span.line) + " is no rotation");
    });
  return norms;
}

void ConstraintReader::read(const Item& root) {
  const Item* list = root.find("constraint");
  if (!list) return;
  if (list->items.size() + model_.coordinates.size() > kMostUnknowns) {
    diagnostics_.error(list->key_span, std::to_string(list->items.size()) + " constraints on " +
                                           std::to_string(model_.coordinates.size()) + " coordinates; at most " +
                                           std::to_string(kMostUnknowns) + " of both together are accepted");
    return;
  }
  for_each_table(*list, "constraint", diagnostics_, [&](const Item& c, std::size_t k) {
    check_keys(c, "a constraint", "constraint", diagnostics_);
    if (is_one_sided(c)) return;  // it is a contact
    const std::size_t first = model_.constraints.size();
    const auto settle = [&] {
      const Item *by = c.find("by"), *active = c.find("active");
      if (by && active)
        throw Failure(active->key_span, "'active' does not go with 'by'",
                      "an input with a formula that holds the mode: u = \"choose(stage, 0, -k*x)\"");
      if (by) keep_by(*by, first, scope_, model_);
      if (active) switch_by(*active, first);
    };
    const Item* named = c.find("name");
    if (named && named->kind != Item::Kind::string) throw Failure(named->span, "a name is a text");
    const std::string name = named ? normal_name(named->text()) : "constraint" + std::to_string(k + 1);
    if (!is_element_name(name)) throw Failure(named->span, "'" + name.substr(0, 40) + "' is not a name");
    scope_.forces.begin(name);
    const Item* equation = c.find("equation");
    if (!equation) throw Failure(c.span, "a constraint has no equation", "equation = \"x' = 0\"");
    const std::vector<Syntax> sides = scope_.equation(*equation);
    const std::string text = equation_text(equation->formula, sides);
    Value left = evaluate(sides[0], scope_), right = evaluate(sides[1], scope_);
    const Item* along = c.find("along");
    const Span place = equation->formula.whole();
    const std::optional<Span> of_name = named ? std::optional(named->span) : std::nullopt;
    if (std::holds_alternative<Expr>(left) && std::holds_alternative<Expr>(right)) {
      if (along) throw Failure(along->key_span, "'along' goes with an equation of vectors, this is one of numbers");
      add_constraint(name, std::get<Expr>(left) - std::get<Expr>(right), text, place, of_name);
      settle();
      scope_.forces.end(name);
      return;
    }
    const Vector difference =
        evaluate_vector_side(left, sides[0], sides[1]) - evaluate_vector_side(right, sides[1], sides[0]);
    std::string dropped;
    std::vector<std::pair<std::string, Expr>> kept;
    int index = 0;
    for (const Direction& d : directions(along, scope_)) {
      const Expr phi = component(difference, d, index++);
      if (proved_zero(phi))
        dropped += (dropped.empty() ? "" : ", ") + name + "." + d.tag;
      else
        kept.push_back({name + "." + d.tag, phi});
    }
    if (kept.empty()) throw Failure(place, "this equation always holds: it constrains nothing");
    if (!dropped.empty())
      model_.notes.push_back("constraint '" + name + "': " + dropped + " vanishes identically and is dropped");
    for (const auto& [full, phi] : kept) add_constraint(full, phi, text, place, of_name);
    settle();
    scope_.forces.end(name);
  });
}

void ConstraintReader::switch_by(const Item& active, std::size_t first) {
  if (!active.is_formula())
    throw Failure(active.span, "'active' is a formula of modes: the constraint holds while it is positive",
                  "mode.caught = 0 and active = \"caught\"");
  const Expr formula = put_masses(model_, evaluate_number(parse_formula(active.formula), scope_));
  bool any = false;
  for (const NodeId id : symbols({&formula, 1})) {
    const Node& n = model_.graph->node(id);
    if (n.kind != Kind::parameter)
      throw Failure(active.span, "'active' holds modes and parameters alone",
                    "an event sets a mode where the motion asks for it: set = {caught = 1}");
    any = any || model_.parameters[n.index].mode;
  }
  if (!any)
    throw Failure(active.span, "no mode occurs in 'active', so that the constraint holds always or never",
                  "mode.caught = 0, active = \"caught\" and an event with set = {caught = 1}");
  for (std::size_t r = first; r < model_.constraints.size(); ++r) {
    const Constraint& c = model_.constraints[r];
    if (c.order > 1)
      throw Failure(c.span,
                    "a constraint with 'active' is one of positions or velocities, and this one holds "
                    "accelerations",
                    "leave out 'active'");
    Contact held;
    held.name = c.name;
    held.gap = c.phi;
    held.friction = held.static_friction = held.restitution = model_.graph->zero();
    held.span = c.span;
    held.held = Switch{formula, c.order, c.equation, std::nullopt};
    switched_.push_back(std::move(held));
  }
  model_.constraints.resize(first);
  model_.names.multipliers.resize(first);
}

std::vector<Contact> ConstraintReader::switched() {
  Column values;
  for (const Parameter& p : model_.parameters) values.push_back(p.value);
  for (Contact& c : switched_)
    collect(diagnostics_, [&] {
      values.push_back(c.held->active);
      const double value = evaluate_parameters<double>(*model_.graph, values).back();
      values.pop_back();
      const bool holds = value > 0;
      model_.notes.push_back({"constraint '" + c.name + "' is " + (holds ? "" : "no ") +
                                  "part of these equations, which hold while the modes are those of the start",
                              ModelNote::About::modes_of_start});
      if (!holds) return;
      c.held->at_start = model_.constraints.size();
      model_.constraints.push_back({c.name, c.gap, c.held->order, c.held->equation, c.span});
      model_.names.multipliers.push_back(c.name);
    });
  return switched_;
}

Vector ConstraintReader::evaluate_vector_side(const Value& side, const Syntax& s, const Syntax& other) const {
  const Value v = as_point(side, scope_, s.span);
  if (const Vector* a = std::get_if<Vector>(&v)) return *a;
  if (const Expr* e = std::get_if<Expr>(&v); e && is_zero(*e)) return zero_vector(*model_.graph);
  throw Failure(s.span, std::string("one side of the equation is a vector, the other is ") + type_name(v),
                is_body(v)     ? body_hint(v, scope_)
                : is_scalar(v) ? hint_for_component(other, scope_)
                               : "");
}

}  // namespace anholon
