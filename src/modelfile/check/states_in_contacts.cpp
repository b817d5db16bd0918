#include "modelfile/check/states_in_contacts.h"

#include <algorithm>

#include "expr/normal.h"

namespace anholon {

namespace {

bool holds(Expr e, Kind kind) {
  const std::vector<NodeId> nodes = symbols({&e, 1});
  return std::any_of(nodes.begin(), nodes.end(), [&](NodeId id) { return e.graph->node(id).kind == kind; });
}

// True if the acceleration along `e`, which is a function of positions (order 0) or of velocities (order 1), holds the
// accelerations q'' by the partial derivatives of `e` alone, and no force.
bool along_itself(const Model& model, Expr e, unsigned order) {
  const Column along = gradient(e, jets(model, order));
  const Expr acceleration = put_state_rates(model, total_derivative(e, 2 - order), 1);
  const Column by = gradient(acceleration, jets(model, 2));
  for (std::size_t a = 0; a < by.size(); ++a)
    if (!proved_zero(by[a] - along[a])) return false;
  return jet_order(acceleration) <= 2 && !holds(acceleration, Kind::multiplier);
}

}  // namespace

void settle_states_in_contacts(Model& model, std::vector<Contact>& contacts, Diagnostics& diagnostics) {
  if (model.states.empty() || diagnostics.has_errors()) return;
  for (Contact& c : contacts) {
    const bool of_velocities = c.held && c.held->order == 1;
    bool good = !holds(c.gap, Kind::state) || along_itself(model, c.gap, of_velocities ? 1 : 0);
    for (Expr* e : {&c.gap, &c.friction, &c.static_friction, &c.restitution}) *e = put_state_rates(model, *e, 1);
    for (Expr& v : c.slip) {
      if (!holds(v, Kind::state)) continue;
      good = good && along_itself(model, v, 1);
      v = put_state_rates(model, v, 1);
    }
    if (!good)
      diagnostics.error(c.span,
                        (c.held ? "the constraint '" + c.name + "' with 'active'" : "the contact '" + c.element + "'") +
                            " holds a state whose rate depends on velocities, accelerations or forces",
                        "a rate of states, positions and time; or a body with a coordinate in place of the state");
  }
}

}  // namespace anholon
