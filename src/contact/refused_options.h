// The options of a run that motions with contacts, or with switched constraints, do not support.
#pragma once
#include "modelfile/contacts.h"
#include "simulation/request.h"

namespace anholon {

// True if the contacts are constraints that are switched.
bool are_switches(const std::vector<Contact>& contacts);
// Throws Failure if there is one, if the motion goes backwards, or if some of the contacts are constraints that are
// switched and others are not.
void refuse_options(const SimulationOptions& o, const Scenario& s, const std::vector<Contact>& contacts);

}  // namespace anholon
