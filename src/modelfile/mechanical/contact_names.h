// The names of contacts, and clashes with the names of other elements of a model.
#pragma once
#include "modelfile/mechanical/contacts.h"

namespace anholon {

// Declares the names of the contacts, because formulas that are read before the contacts may contain their forces.
void declare_contacts(const Item& root, Scope& scope);

// Reports a constraint with the name of a contact, whose force would have the same column, and an event with the name
// of an event of a contact. Errors go to the diagnostics.
void check_names_of_contacts(const std::vector<Contact>& contacts, const Model& model, Diagnostics& diagnostics);

}  // namespace anholon
