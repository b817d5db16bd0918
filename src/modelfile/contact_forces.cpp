#include "modelfile/contact_forces.h"

#include <algorithm>

#include "expr/normal.h"

namespace anholon {

namespace {

// Finds "floor", "floor.t1", "floor.rolling.t2" among the contacts.
std::optional<ContactForces::Force> force_of(const std::string& path, const std::vector<Contact>& contacts) {
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (path == contacts[c].name && !contacts[c].under) return ContactForces::Force{c, std::nullopt};
    for (std::size_t k = 0; k < contacts[c].slip.size(); ++k)
      if (path == contacts[c].name + ".t" + std::to_string(k + 1)) return ContactForces::Force{c, k};
  }
  return std::nullopt;
}

// Lists the forces: "lambda.floor, lambda.floor.t1".
std::string known_forces(const std::vector<Contact>& contacts) {
  std::string list;
  for (const Contact& c : contacts) {
    if (!c.under) list += (list.empty() ? "lambda." : ", lambda.") + c.name;
    for (std::size_t k = 0; k < c.slip.size(); ++k) list += ", lambda." + c.name + ".t" + std::to_string(k + 1);
  }
  return "the forces of contacts are " + list;
}

bool is_contact_force(const Node& n) { return n.kind == Kind::multiplier && n.index >= kContactForces; }

// Substitutes the forces of the model at the start: those of the constraints that hold there, and zeros.
Expr with_forces_at_start(const Model& model, const std::vector<Contact>& contacts,
                          const std::vector<ContactForces::Force>& forces, Expr e) {
  Graph& g = *model.graph;
  return with_contact_forces(g, e, [&](const Node& n) {
    const std::size_t k = n.index - kContactForces, c = forces[k].contact;
    if (c >= contacts.size() || !contacts[c].held || !contacts[c].held->at_start) return g.zero();
    return g.multiplier(static_cast<std::uint32_t>(*contacts[c].held->at_start), n.order);
  });
}

}  // namespace

// Returns a zero that the graph does not recognize: the graph refuses divisions by zero, the evaluation of rows does
// not. Each force has a zero of its own, so that none cancels another.
static Expr hidden_zero(Graph& g, const Node& force) {
  const Expr positive = g.number(static_cast<long>(force.index - kContactForces) + 1) + g.time() * g.time();
  return g.apply(Function::sign, positive) - g.one();
}

Expr with_contact_forces(Graph& g, Expr formula, const std::function<Expr(const Node&)>& force) {
  const auto put = [&](bool hide_zeros) {
    return substitute({&formula, 1}, [&](NodeId id) {
      const Node n = g.node(id);
      if (!is_contact_force(n)) return Expr{};
      const Expr f = force(n);
      return hide_zeros && is_zero(f) ? hidden_zero(g, n) : f;
    })[0];
  };
  try {
    return put(false);
  } catch (const Failure&) {  // a division by zero
    return put(true);
  }
}

// True if R(lambda) = R(0) + sum lambda dR/dlambda, by an exact test.
static bool is_linear_in_forces(Graph& g, Expr rate) {
  Column forces;
  for (const NodeId id : symbols({&rate, 1}))
    if (is_contact_force(g.node(id))) forces.push_back({&g, id});
  const Column slopes = gradient(rate, forces);
  Expr rest = rate - with_contact_forces(g, rate, [&](const Node&) { return g.zero(); });
  for (std::size_t k = 0; k < forces.size(); ++k) rest = rest - forces[k] * slopes[k];
  return proved_zero(rest);
}

void settle_contact_forces(const Scope& scope, Model& model, std::vector<Contact>& contacts, Diagnostics& diagnostics) {
  const auto& asked = scope.forces.of_contacts.asked();
  if (asked.empty()) return;
  auto found = std::make_shared<ContactForces>();
  std::vector<bool>
      unknown;  // no formula contains a path that is part of another one, such as floor.rolling of floor.rolling.t1
  for (const auto& [path, use] : asked) {
    const std::optional<ContactForces::Force> force = force_of(path, contacts);
    unknown.push_back(!force);
    found->forces.push_back(force.value_or(ContactForces::Force{}));
  }
  // If there are errors, a contact with a mistake may be missing, so its forces are not reported as unknown.
  const bool tell = !diagnostics.has_errors();
  const auto holds_force = [&](Expr e) {
    bool any = false;
    for (const NodeId id : symbols({&e, 1})) {
      const Node& n = model.graph->node(id);
      if (!is_contact_force(n)) continue;
      any = true;
      const std::size_t k = n.index - kContactForces;
      if (!unknown[k]) continue;
      unknown[k] = false;
      if (tell)
        diagnostics.error(asked[k].second, "there is no force '" + asked[k].first + "' of a contact",
                          known_forces(contacts));
    }
    return any;
  };
  const auto at_start = [&](Expr e) { return with_forces_at_start(model, contacts, found->forces, e); };
  const auto settle = [&](Expr& value, Expr& open, ContactForces::Formula::Of of, std::size_t index) {
    if (!holds_force(value)) return;
    found->formulas.push_back({of, index, value});
    value = at_start(value);
    open = {};  // the mode substitutes the forces in the value
  };
  for (std::size_t k = 0; k < model.monitors.size(); ++k)
    settle(model.monitors[k].value, model.monitors[k].open, ContactForces::Formula::Of::monitor, k);
  for (std::size_t k = 0; k < model.events.size(); ++k)
    settle(model.events[k].when, model.events[k].open_when, ContactForces::Formula::Of::event, k);
  for (std::size_t k = 0; k < model.outputs.size(); ++k)
    for (std::size_t i = 0; i < model.outputs[k].values.size(); ++i) {
      Expr& value = model.outputs[k].values[i];
      if (holds_force(value)) found->formulas.push_back({ContactForces::Formula::Of::output, k, value, i});
      value = at_start(value);
    }
  const auto refuse = [&](Expr& e, Span span, const char* what) {
    if (!holds_force(e)) return;
    diagnostics.error(span, std::string(what) + " holds the force of a contact",
                      "such a formula stands in monitors, outputs, rates of states and the 'when' of events");
    e = at_start(e);
  };
  const bool switched =
      std::any_of(contacts.begin(), contacts.end(), [](const Contact& c) { return c.held.has_value(); });
  for (std::size_t k = 0; k < model.states.size(); ++k) {
    StateVariable& z = model.states[k];
    if (switched) {
      refuse(z.rate, z.span, "a rate of a model with 'active'");
      continue;
    }
    if (holds_force(z.rate) && !is_linear_in_forces(*model.graph, z.rate))
      diagnostics.error(z.span, "a rate is not linear in the forces of contacts",
                        "an impact adds to the state what its impulses give, and only a linear rate tells that: "
                        "lambda.NAME.t1*v, without abs and powers");
    settle(z.rate, z.open_rate, ContactForces::Formula::Of::rate, k);
  }
  for (Condition& c : model.initial.conditions) refuse(c.residual, c.span, "a condition");
  for (Event& e : model.events)
    for (Assignment& a : e.set) refuse(a.value, a.span, "a value that an event sets");
  for (Contact& c : contacts) c.forces = found;
}

}  // namespace anholon
