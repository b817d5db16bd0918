#include "ensemble/with_contacts.h"

#include "base/diagnostic.h"
#include "contact/hybrid.h"
#include "contact/mode_model.h"

namespace anholon {

void move_with(const std::vector<Contact>& contacts, EnsembleOptions& o) {
  if (contacts.empty()) return;
  if (!o.reductions.list.empty())
    throw Failure({}, "a motion with contacts has no polynomials to reduce",
                  "leave out the reductions; rows at times, and the columns of the contacts, are there");
  o.own_motion = [&contacts](Workspace& s, const SimulationOptions& options, RowSink& rows) {
    return simulate_with_contacts(s, contacts, options, rows);
  };
  o.own_columns = contact_columns(contacts);
  // The estimate compares with a second run, which a motion with contacts does not have.
  o.estimate = ErrorEstimate::never;
}

}  // namespace anholon
