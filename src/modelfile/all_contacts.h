// All contacts of a model file, after its other sections have been read.
#pragma once
#include "modelfile/mechanical/contacts.h"

namespace anholon {

// Reads the contacts, appends `switched`, the constraints that hold in some modes only, and settles the states and the
// forces of contacts that formulas contain. A note of the model names the contacts, because its equations hold while they
// are open. Mistakes are added to the diagnostics.
std::vector<Contact> read_all_contacts(const Item& root, const std::vector<Contact>& switched, Scope& scope,
                                       Model& model, Diagnostics& diagnostics);

}  // namespace anholon
