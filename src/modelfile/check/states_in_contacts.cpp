#include "modelfile/check/states_in_contacts.h"

#include <algorithm>

#include "expr/normal.h"

namespace anholon {

namespace {

bool holds(Expr e, Kind kind) {
  const std::vector<NodeId> nodes = symbols({&e, 1});
  return std::any_of(nodes.begin(), nodes.end(), [&](NodeId id) { return e.graph->node(id).kind == kind; });
}

// True if the acceleration along a gap or a slip velocity holds the accelerations q'' by the coefficients `along` alone,
// and no force.
bool accelerates_along(const Model& model, Expr acceleration, const Column& along) {
  const Expr e = put_state_rates(model, acceleration, 1);
  const Column by = gradient(e, jets(model, 2));
  for (std::size_t a = 0; a < by.size(); ++a)
    if (!proved_zero(by[a] - along[a])) return false;
  return jet_order(e) <= 2 && !holds(e, Kind::multiplier);
}

}  // namespace

void settle_states_in_contacts(Model& model, std::vector<Contact>& contacts, Diagnostics& diagnostics) {
  if (model.states.empty() || diagnostics.has_errors()) return;
  for (Contact& c : contacts) {
    bool good = !holds(c.gap, Kind::state) ||
                accelerates_along(model, total_derivative(c.gap, 2), gradient(c.gap, jets(model, 0)));
    for (Expr& v : c.slip) {
      if (!holds(v, Kind::state)) continue;
      good = good && accelerates_along(model, total_derivative(v), gradient(v, jets(model, 1)));
      v = put_state_rates(model, v, 1);
    }
    if (!good)
      diagnostics.error(c.span,
                        "the contact '" + c.element +
                            "' holds a state whose rate depends on velocities, accelerations or forces",
                        "a rate of states, positions and time; or a body with a coordinate in place of the state");
  }
}

}  // namespace anholon
