#include "setup/inputs.h"

#include <algorithm>
#include <cmath>
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

// The system with these inputs as symbols.
System with_symbols(const Scenario& s, const std::set<std::size_t>& inputs) {
  auto model = std::make_shared<Model>(*s.model);
  for (std::size_t k : inputs) model->controls[k].value.reset();
  put_inputs_into_inputs(*model, inputs);
  put_inputs(*model);
  System system = implicit_system(model, *s.mechanics, *s.system.form, s.independent, s.elimination);
  drop_absent(system, s.structure);
  return system;
}

// Those of the inputs that act as they should when they are set.
std::set<std::size_t> free_ones(const Scenario& s, const System& system, std::set<std::size_t> inputs) {
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
  for (const Monitor& m : system.model->monitors) holds(m.value);
  for (const Event& e : system.model->events) {
    holds(e.when);
    for (const Assignment& a : e.set) holds(a.value);
  }
  std::erase_if(inputs, [&](std::size_t k) { return !occurring.count(k) || !s.model->controls[k].put_into.empty(); });
  return inputs;
}

}  // namespace

OpenSystem open_inputs(Workspace& s) {
  std::set<std::size_t> inputs;
  for (std::size_t k = 0; k < s.model->controls.size(); ++k)
    if (const Control& u = s.model->controls[k]; u.value && !u.constraint && known_before_solving(s, *u.value))
      inputs.insert(k);
  if (inputs.empty()) return {s.system, {}};
  System system = with_symbols(s, inputs);
  if (const auto fewer = free_ones(s, system, inputs); fewer != inputs) {
    inputs = fewer;
    system = with_symbols(s, inputs);
  }
  OpenSystem open{std::move(system), {}};
  for (std::size_t k : inputs) open.inputs.push_back({k, *s.model->controls[k].value});
  return open;
}

// The value of a formula at the consistent start.
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
               "is differentiated, or no equation, output and event holds it"
             : "its formula is put into " + u.put_into;
}

static bool holds_rate_of(Expr e, const std::set<std::size_t>& inputs) {
  for (const NodeId id : symbols({&e, 1}))
    if (const Node& n = e.graph->node(id); n.kind == Kind::control && n.order > 0 && inputs.count(n.index)) return true;
  return false;
}

InputsAsParameters inputs_as_parameters(const Scenario& s, const std::vector<std::string>& names) {
  Workspace own(s);
  std::set<std::size_t> free;
  for (const InputFormula& u : open_inputs(own).inputs) free.insert(u.control);
  std::vector<std::string> known;
  for (const Control& u : s.model->controls) known.push_back(u.name);
  const std::shared_ptr<Model> m = given_model(s);
  InputsAsParameters out{m, {}, {}, {}};
  for (const std::string& name : names)
    if (const auto at = std::find(known.begin(), known.end(), name); at == known.end()) {
      const std::string near = did_you_mean(name, known);
      throw Failure({}, "there is no input '" + name + "'",
                    !near.empty()   ? "did you mean '" + near + "'?"
                    : known.empty() ? "[input] declares inputs"
                                    : "");
    } else if (!free.count(static_cast<std::size_t>(at - known.begin()))) {
      throw Failure({}, "the input '" + name + "' cannot be set from outside",
                    why_not(s.model->controls[static_cast<std::size_t>(at - known.begin())]));
    }
  std::set<std::size_t> given;
  for (const std::size_t k : free) {
    Control& u = m->controls[k];
    if (!names.empty() && std::find(names.begin(), names.end(), u.name) == names.end()) continue;
    const Rational value = value_at_start(s, *m, *u.value);
    out.names.push_back(u.name);
    out.formulas.push_back(u.value->id);
    u.value = m->graph->parameter(static_cast<std::uint32_t>(m->parameters.size()));
    m->parameters.push_back({u.name, m->graph->number(value), "", u.span});
    m->names.parameters.push_back(u.name);
    if (!m->parameter_units.empty()) m->parameter_units.emplace_back();
    given.insert(k);
  }
  std::erase_if(m->monitors, [&](const Monitor& o) {
    if (!holds_rate_of(o.open.graph ? o.open : o.value, given)) return false;
    out.left_out.push_back(o.name);
    return true;
  });
  put_inputs_into_inputs(*m, given);
  put_inputs(*m);
  return out;
}

}  // namespace anholon
