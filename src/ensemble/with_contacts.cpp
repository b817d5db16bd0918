#include "ensemble/with_contacts.h"

#include "contact/hybrid.h"
#include "contact/mode/mode_model.h"
#include "contact/mode/switched_model.h"

namespace anholon {

void move_with(const std::vector<Contact>& contacts, EnsembleOptions& o) {
  if (contacts.empty()) return;
  o.own_motion = [&contacts](Workspace& s, const SimulationOptions& options, RowSink& rows) {
    return simulate_with_contacts(s, contacts, options, rows);
  };
  o.own_columns = contact_columns(contacts);
  // The estimate compares with a second run, which a motion with contacts does not have.
  o.estimate = ErrorEstimate::never;
}

void switch_with(const std::vector<Contact>& contacts, const Model& model, EnsembleOptions& o) {
  Switches switches;
  for (const Contact& c : contacts) {
    if (!c.held) return;  // motions refuse models with contacts and switched constraints
    switches.active.push_back(c.held->active);
  }
  if (contacts.empty()) return;
  switches.put = [&contacts](Model& of_case) { put_constraints_that_hold(of_case, contacts); };
  switches.multipliers = model.names.multipliers;
  o.switches = std::move(switches);
}

}  // namespace anholon
