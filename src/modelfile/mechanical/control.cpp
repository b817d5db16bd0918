#include "modelfile/mechanical/control.h"

#include <algorithm>

#include "formula/indices.h"
#include "formula/units.h"
#include "modelfile/text/collect.h"
#include "modelfile/text/keys.h"

namespace anholon {

void declare_controls(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics) {
  const Item* section = find_section(root, "input", diagnostics);
  if (!section) return;
  for (const Item& i : section->items) {
    const auto declare = [&] {
      Scope::Declaration d;
      d.role = Scope::Role::control;
      d.index = model.controls.size();
      d.span = i.key_span;
      if (!i.is_formula() && !(i.kind == Item::Kind::table && i.items.empty()))
        throw Failure(i.span, "an input is a formula, or {} where a constraint is kept by it",
                      i.key + " = \"-2*x - x'\"");
      scope.declare(i.key, d);
      model.controls.push_back({i.key, std::nullopt, std::nullopt, i.key_span});
      model.names.controls.push_back(i.key);
    };
    if (!collect(diagnostics, declare)) scope.note_failed(i.key);
  }
}

// Substitutes inputs in the formulas of other inputs until none is left.
static void close(Model& model, Diagnostics& diagnostics) {
  const Graph& g = *model.graph;
  for (std::size_t depth = 0; depth <= model.controls.size(); ++depth) {
    bool open = false;
    for (Control& u : model.controls) {
      if (!u.value) continue;
      const std::vector<NodeId> all = symbols({&*u.value, 1});
      const auto loose = std::find_if(all.begin(), all.end(), [&](NodeId id) {
        return g.node(id).kind == Kind::control && model.controls[g.node(id).index].value;
      });
      if (loose == all.end()) continue;
      open = true;
      if (!u.open.graph) u.open = *u.value;
      if (depth == model.controls.size()) {
        diagnostics.error(u.span, "the input '" + u.name + "' is defined through itself");
        u.value = model.graph->zero();
        continue;
      }
      u.value = substitute({&*u.value, 1}, [&](NodeId id) {
        const Node n = g.node(id);
        return n.kind == Kind::control && model.controls[n.index].value
                   ? total_derivative(*model.controls[n.index].value, n.order)
                   : Expr{};
      })[0];
    }
    if (!open) return;
  }
}

void read_controls(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics) {
  const Item* section = root.find("input");
  if (!section || section->kind != Item::Kind::table) return;
  for (const Item& i : section->items) {
    const auto u =
        std::find_if(model.controls.begin(), model.controls.end(), [&](const Control& c) { return c.name == i.key; });
    if (u == model.controls.end() || !i.is_formula()) continue;
    // An input whose formula has an error is not an open one.
    if (!collect(diagnostics, [&] { u->value = scope.number(i); })) u->value = model.graph->zero();
  }
  close(model, diagnostics);
}

void keep_by(const Item& by, std::size_t first, const Scope& scope, Model& model) {
  std::vector<const Item*> names;
  if (by.kind == Item::Kind::array)
    for (const Item& i : by.items) names.push_back(&i);
  else
    names.push_back(&by);
  const std::size_t equations = model.constraints.size() - first;
  if (names.size() != equations)
    throw Failure(by.span, std::to_string(names.size()) + " inputs for " + std::to_string(equations) + " equations",
                  "as many inputs as equations: by = [\"u\", \"v\"]");
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k]->kind != Item::Kind::string)
      throw Failure(names[k]->span, "'by' is the name of an input, or a list of them", "by = \"u\"");
    const std::string name = normal_name(names[k]->text());
    const auto it = scope.declarations().find(name);
    if (it == scope.declarations().end() || it->second.role != Scope::Role::control) {
      std::vector<std::string> known;
      for (const Control& u : model.controls) known.push_back(u.name);
      const std::string near = did_you_mean(name, known);
      throw Failure(names[k]->span,
                    "there is no input '" + name + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"),
                    "by names an [input], which becomes the unknown that keeps the constraint");
    }
    Control& u = model.controls[it->second.index];
    if (u.constraint)
      throw Failure(names[k]->span, "the input '" + name + "' keeps the constraint '" +
                                        model.constraints[*u.constraint].name + "' already");
    if (u.value)
      throw Failure(names[k]->span,
                    "the input '" + name + "' has a formula, so it cannot be the unknown that keeps a constraint",
                    name + " = {} in [input] leaves it open, or name another input");
    u.constraint = first + k;
    model.constraints[first + k].by = it->second.index;
    model.notes.push_back("constraint '" + model.constraints[first + k].name + "' is kept by the input '" + name +
                          "' (servo): no ideal reaction acts");
  }
}

void check_kept(const Model& model, Diagnostics& diagnostics) {
  for (const Control& u : model.controls)
    if (!u.value && !u.constraint && !diagnostics.has_errors())
      diagnostics.error(u.span, "the input '" + u.name + "' has no formula, and no constraint is kept by it",
                        u.name + " = \"-2*x - x'\", or by = \"" + u.name + "\" in a constraint");
}

Expr with_feedback(Model& model, Expr e, const std::string& element) {
  const Graph& g = *model.graph;
  return substitute({&e, 1}, [&](NodeId id) {
    const Node n = g.node(id);
    if (n.kind != Kind::control) return Expr{};
    Control& u = model.controls[n.index];
    if (!u.value || jet_order(*u.value) < 0) return Expr{};
    if (u.put_into.empty()) u.put_into = element;
    return total_derivative(*u.value, n.order);
  })[0];
}

// ---- outputs ---------------------------------------------------------------------------------

static void record(const std::string& column, Expr as_read, const OutputQuantity& output, Model& model) {
  const auto& taken = model.names.coordinates;
  const auto is_state = [&](const StateVariable& z) { return z.name == column; };
  if (column == "t" || std::any_of(model.states.begin(), model.states.end(), is_state) ||
      std::find(taken.begin(), taken.end(), column) != taken.end() ||
      std::any_of(model.monitors.begin(), model.monitors.end(), [&](const Monitor& m) { return m.name == column; }))
    throw Failure(output.span, "a column '" + column + "' is there already", "give the output a name of its own");
  Expr value = put_masses(model, as_read), open = open_form(model, as_read);
  // Converts the output to its requested unit.
  if (!output.unit.empty()) {
    const Unit unit = *read_unit(output.unit);
    const Expr factor = model.graph->number(Rational(1 / unit.factor));
    const Expr turns = pow(model.graph->pi(), Rational(-unit.pi));
    for (Expr* e : {&value, &open})
      if (e->graph) *e = *e * factor * turns;
  }
  model.monitors.push_back({column, value, output.span, open});
}

static void read_output(const Item& i, Scope& scope, Model& model, Diagnostics& diagnostics) {
  OutputQuantity out;
  out.name = i.key;
  out.span = i.key_span;
  if (!is_element_name(out.name))
    throw Failure(i.key_span, "'" + out.name.substr(0, 40) + "' is not a name",
                  "letters (a-z, A-Z, Greek), digits and _, not starting with a digit");
  const Item* value = &i;
  if (i.kind == Item::Kind::table) {
    check_keys(i, "an output", "output", diagnostics);
    value = i.find("value");
    if (!value)
      throw Failure(i.key_span, "the output '" + out.name + "' has no value", "{value = \"…\", unit = \"km\"}");
    if (const Item* unit = i.find("unit")) out.unit = unit_text(*unit);
    if (const Item* doc = i.find("doc")) {
      if (doc->kind != Item::Kind::string) throw Failure(doc->span, "'doc' is a text");
      out.doc = doc->text();
    }
    if (const Item* c = i.find("conserved")) {
      if (c->kind != Item::Kind::boolean) throw Failure(c->span, "'conserved' is true or false");
      out.conserved = c->truth;
    }
  }
  Value v;
  if (value->kind == Item::Kind::array && value->items.size() == 3) {
    const auto component = [&](std::size_t k) {
      return evaluate_number(parse_formula(value->items[k].formula), scope);
    };
    const Expr x = component(0), y = component(1), z = component(2);
    v = Vector{x, y, z};
  } else if (value->is_formula()) {
    v = as_point(evaluate(parse_formula(value->formula), scope), scope, value->span);
  } else {
    throw Failure(value->span, "an output is a formula, a vector, or a table with its value",
                  "height = {value = \"norm(P) - R\", unit = \"km\"}");
  }
  if (const Expr* e = std::get_if<Expr>(&v))
    out.values = {*e};
  else if (const Vector* a = std::get_if<Vector>(&v))
    out.values = {a->x, a->y, a->z};
  else
    throw Failure(value->span, std::string("an output is a number or a vector, this is ") + type_name(v),
                  is_body(v) ? body_hint(v, scope) : "");
  if (out.values.size() == 1)
    record(out.name, out.values[0], out, model);
  else
    for (std::size_t k = 0; k < 3; ++k) record(out.name + "." + std::string(1, "xyz"[k]), out.values[k], out, model);
  model.outputs.push_back(std::move(out));
}

void read_outputs(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics) {
  const Item* section = find_section(root, "output", diagnostics);
  if (!section) return;
  const ForcesInFormulas::Allowed allowed(scope.forces);
  for (const Item& i : section->items) collect(diagnostics, [&] { read_output(i, scope, model, diagnostics); }, i);
}

}  // namespace anholon
