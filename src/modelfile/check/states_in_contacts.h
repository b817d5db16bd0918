// Contacts, and constraints with `active`, that hold a state of the model, such as the speed of a belt.
#pragma once
#include "modelfile/mechanical/contacts.h"

namespace anholon {

// Replaces rates of states by their formulas in gaps, slip velocities and coefficients, and in what `active` constrains.
// Adds an error for each contact whose gap or slip velocity, and for each constraint with `active`, that holds a state with
// a rate that depends on velocities, accelerations or forces: it would move the state, and its law has no force for that.
void settle_states_in_contacts(Model& model, std::vector<Contact>& contacts, Diagnostics& diagnostics);

}  // namespace anholon
