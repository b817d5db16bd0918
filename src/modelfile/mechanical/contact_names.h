// The names of contacts, and those that they share with other things of a model.
#pragma once
#include "modelfile/mechanical/contacts.h"

namespace anholon {

// Declares the names of the contacts, whose forces may stand in formulas that are read before the contacts.
void declare_contacts(const Item& root, Scope& scope);

// A constraint of the name of a contact, whose force has the same column, and an event of the name of one that the contact has.
// Errors go to the diagnostics.
void check_names_of_contacts(const std::vector<Contact>& contacts, const Model& model, Diagnostics& diagnostics);

}  // namespace anholon
