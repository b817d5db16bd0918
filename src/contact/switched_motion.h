// Computes a motion with constraints that hold in some modes: events set the modes, and between them the motion is that
// of a model of its own (contact/mode/switched_model.h). When a constraint begins to hold, the velocities jump by the least
// change in the mass norm after which it holds (theory: contact).
#pragma once
#include "modelfile/contacts.h"
#include "simulation/simulate.h"

namespace anholon {

// `s`: the model in the modes of the start, at the consistent initial state; `contacts`: its constraints with `active`.
// Throws Failure for options that switched constraints do not support, and for events that set forces or accelerations.
SimulationReport simulate_with_switches(Workspace& s, const std::vector<Contact>& contacts,
                                        const SimulationOptions& options, RowSink& sink);

}  // namespace anholon
