#include "ensemble/with_contacts.h"

#include "contact/hybrid.h"
#include "contact/mode/mode_model.h"
#include "contact/mode/switched_model.h"
#include "contact/refused_options.h"

namespace anholon {

void move_with(const std::vector<Contact>& contacts, const Scenario& s, EnsembleOptions& o) {
  if (contacts.empty()) return;
  SimulationOptions of_motion;
  of_motion.state = o.state;
  of_motion.to = o.to;
  refuse_options(of_motion, s, contacts);
  o.own_motion = [&contacts](Workspace& of_case, const SimulationOptions& options, RowSink& rows) {
    return simulate_with_contacts(of_case, contacts, options, rows);
  };
  o.own_columns = contact_columns(contacts);
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
