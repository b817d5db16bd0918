#include "setup/inputs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace anholon {

namespace {

bool known_before_solving(const Scenario& s, Expr value) {
  const Graph& g = *s.model->graph;
  for (NodeId id : symbols({&value, 1})) {
    const Node& n = g.node(id);
    if (n.kind == Kind::time || n.kind == Kind::parameter) continue;
    const auto j = s.system.variable(id);
    if (!j || static_cast<int>(n.order) >= s.structure.d[*j]) return false;
  }
  return true;
}

// Returns the system with these inputs as symbols.
System with_symbols(const Scenario& s, const std::set<std::size_t>& inputs) {
  auto model = std::make_shared<Model>(*s.model);
  for (std::size_t k : inputs) model->controls[k].value.reset();
  put_inputs_into_inputs(*model, inputs);
  put_inputs(*model);
  System system = implicit_system(model, *s.mechanics, *s.system.form, s.independent, s.elimination);
  drop_absent(system, s.structure);
  return system;
}

// Returns the inputs that act as they should when they are set. `in_inputs`: also those that act only in other inputs.
std::set<std::size_t> free_ones(const Scenario& s, const System& system, std::set<std::size_t> inputs, bool in_inputs) {
  const Graph& g = *s.model->graph;
  std::set<std::size_t> occurring;
  for (std::size_t i = 0; i < system.size(); ++i)
    for (NodeId id : symbols({&system.equations[i], 1})) {
      const Node& n = g.node(id);
      if (n.kind != Kind::control || !inputs.count(n.index)) continue;
      occurring.insert(n.index);
      if (n.order > 0 || s.structure.c[i] > 0) inputs.erase(n.index);
    }
  const auto holds = [&](Expr e) {
    for (NodeId id : symbols({&e, 1}))
      if (const Node& n = g.node(id); n.kind == Kind::control) occurring.insert(n.index);
  };
  if (in_inputs)
    for (std::size_t k : inputs)
      if (const Expr open = s.model->controls[k].open; open.graph)
        for (NodeId id : symbols({&open, 1}))
          if (const Node& n = g.node(id); n.kind == Kind::control && n.order == 0) occurring.insert(n.index);
  for (const Monitor& m : system.model->monitors) holds(m.value);
  for (const Event& e : system.model->events) {
    holds(e.when);
    for (const Assignment& a : e.set) holds(a.value);
  }
  std::erase_if(inputs, [&](std::size_t k) { return !occurring.count(k) || !s.model->controls[k].put_into.empty(); });
  return inputs;
}

// Returns the system in which those of the wanted inputs that can be set are symbols.
OpenSystem opened(Workspace& s, const std::set<std::size_t>& wanted, bool in_inputs) {
  std::set<std::size_t> inputs;
  for (std::size_t k : wanted)
    if (const Control& u = s.model->controls[k]; u.value && !u.constraint && known_before_solving(s, *u.value))
      inputs.insert(k);
  if (inputs.empty()) return {s.system, {}};
  System system = with_symbols(s, inputs);
  // If an input is no symbol, its formula brings other inputs into the equations.
  for (std::set<std::size_t> fewer; (fewer = free_ones(s, system, inputs, in_inputs)) != inputs;) {
    inputs = fewer;
    system = with_symbols(s, inputs);
  }
  OpenSystem open{std::move(system), {}};
  for (std::size_t k : inputs) open.inputs.push_back({k, *s.model->controls[k].value});
  return open;
}

std::set<std::size_t> all_inputs(const Model& model) {
  std::set<std::size_t> all;
  for (std::size_t k = 0; k < model.controls.size(); ++k) all.insert(k);
  return all;
}

}  // namespace

OpenSystem open_inputs(Workspace& s) { return opened(s, all_inputs(*s.model), false); }

std::vector<std::string> inputs_with_rates(const Scenario& s) {
  Workspace own(s);
  std::set<std::size_t> inputs;
  for (const std::size_t k : all_inputs(*own.model))
    if (const Control& u = own.model->controls[k]; u.value && !u.constraint) inputs.insert(k);
  Column es = with_symbols(own, inputs).equations;
  for (const OutputQuantity& o : own.model->outputs) es.insert(es.end(), o.values.begin(), o.values.end());
  std::set<std::size_t> found;
  for (const NodeId id : symbols(es))
    if (const Node& n = own.graph().node(id); n.kind == Kind::control && n.order > 0 && inputs.count(n.index))
      found.insert(n.index);
  std::vector<std::string> names;
  for (const std::size_t k : found) names.push_back(own.model->controls[k].name);
  return names;
}

// Returns the value of a formula at the consistent start.
static Rational value_at_start(const Scenario& s, const Model& model, Expr formula) {
  const Tape tape = compile({&formula, 1});
  Machine<double> machine(tape, 0, parameter_values<double>(model));
  bind(machine, *model.graph, [&](const Node& n, NodeId) {
    switch (n.kind) {
    case Kind::time:
      return s.state.t;
    case Kind::jet:
      return n.order == 0 ? s.state.q[n.index] : s.state.qd[n.index];
    default:
      return s.state.states[n.index];
    }
  });
  machine.evaluate();
  if (const double value = machine.value(0); std::isfinite(value)) return Rational(value);
  return Rational(0);
}

static std::string why_not(const Control& u) {
  return u.put_into.empty()
             ? "it keeps a constraint, holds accelerations or multipliers, or stands in an equation that "
               "is differentiated, or acts by its rate, or no equation, output, event and other input holds it"
             : "its formula is put into " + u.put_into;
}

static bool holds_rate_of(Expr e, const std::set<std::size_t>& inputs) {
  for (const NodeId id : symbols({&e, 1}))
    if (const Node& n = e.graph->node(id); n.kind == Kind::control && n.order > 0 && inputs.count(n.index)) return true;
  return false;
}

// Returns the formula of an input, in which other given inputs are the parameters of `m`. Their rates, which have no
// values of their own, are those of their formulas. `given`: the formulas of these inputs, with all others substituted.
static Expr with_inputs_as_parameters(const Model& m, std::size_t input, const std::map<std::size_t, Expr>& given) {
  const Expr open = m.controls[input].open;
  if (!open.graph) return given.at(input);
  const Expr known = substitute({&open, 1}, [&](NodeId id) {
    const Node& n = open.graph->node(id);
    if (n.kind != Kind::control || n.order == 0 || !given.count(n.index)) return Expr{};
    return total_derivative(given.at(n.index), n.order);
  })[0];
  return put_controls(m, {&known, 1})[0];
}

InputsAsParameters inputs_as_parameters(const Scenario& s, const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const Control& u : s.model->controls) known.push_back(u.name);
  std::set<std::size_t> wanted;
  for (std::size_t k = 0; k < known.size(); ++k)
    if (names.empty() || std::find(names.begin(), names.end(), known[k]) != names.end()) wanted.insert(k);
  Workspace own(s);
  std::set<std::size_t> given;
  for (const InputFormula& u : opened(own, wanted, true).inputs) given.insert(u.control);
  std::vector<std::size_t> order;  // the inputs in the order of `names`, or of the model
  for (const std::string& name : names) {
    const std::size_t k = static_cast<std::size_t>(std::find(known.begin(), known.end(), name) - known.begin());
    if (k == known.size()) {
      const std::string near = did_you_mean(name, known);
      throw Failure({}, "there is no input '" + name + "'",
                    !near.empty()   ? "did you mean '" + near + "'?"
                    : known.empty() ? "[input] declares inputs"
                                    : "");
    }
    if (!given.count(k))
      throw Failure({}, "the input '" + name + "' cannot be set from outside", why_not(s.model->controls[k]));
    if (std::find(order.begin(), order.end(), k) != order.end())
      throw Failure({}, "the input '" + name + "' is given twice", "each input is one entry of u");
    order.push_back(k);
  }
  if (names.empty()) order.assign(given.begin(), given.end());
  const std::shared_ptr<Model> m = given_model(s);
  InputsAsParameters out{m, {}, {}, {}, {}};
  std::map<std::size_t, Expr> formulas;
  for (const std::size_t k : order) {
    Control& u = m->controls[k];
    formulas.emplace(k, *u.value);
    const Rational value = value_at_start(s, *m, *u.value);
    out.names.push_back(u.name);
    out.formulas.push_back(u.value->id);
    u.value = m->graph->parameter(static_cast<std::uint32_t>(m->parameters.size()));
    m->parameters.push_back({u.name, m->graph->number(value), "", u.span});
    m->names.parameters.push_back(u.name);
    if (!m->parameter_units.empty()) m->parameter_units.emplace_back();
  }
  std::erase_if(m->monitors, [&](const Monitor& o) {
    if (!holds_rate_of(o.open.graph ? o.open : o.value, given)) return false;
    out.left_out.push_back(o.name);
    return true;
  });
  put_inputs_into_inputs(*m, given);
  put_inputs(*m);
  for (const std::size_t k : order) out.open_formulas.push_back(with_inputs_as_parameters(*m, k, formulas).id);
  return out;
}

}  // namespace anholon
