// Names that contacts share with other things of a model.
#pragma once
#include "modelfile/mechanical/contacts.h"

namespace anholon {

// A constraint of the name of a contact, whose force has the same column, and an event of the name of one that the contact has.
// Errors go to the diagnostics.
void check_names_of_contacts(const std::vector<Contact>& contacts, const Model& model, Diagnostics& diagnostics);

}  // namespace anholon
