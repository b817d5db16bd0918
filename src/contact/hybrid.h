// Computes a motion with contacts: segments, in each of which the contacts keep their modes and the motion is that of a
// model of its own (contact/mode/mode_model.h), joined to one run.
#pragma once
#include "modelfile/contacts.h"
#include "simulation/simulate.h"

namespace anholon {

// `s`: the model with all contacts open, at the consistent initial state. Throws Failure for options that contacts do
// not support.
SimulationReport simulate_with_contacts(Workspace& s, const std::vector<Contact>& contacts,
                                        const SimulationOptions& options, RowSink& sink);

}  // namespace anholon
