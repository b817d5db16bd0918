#include "ensemble/with_contacts.h"

#include "contact/hybrid.h"
#include "contact/mode_model.h"

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

}  // namespace anholon
