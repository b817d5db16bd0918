// Sweeps of models with contacts: each case by simulate_with_contacts, alone.
#pragma once
#include "ensemble/case.h"
#include "modelfile/contacts.h"

namespace anholon {

// Lets the cases move with these contacts, if there are any; call it when all other options are set. Throws Failure for
// options that do not go with contacts. The contacts have to outlive the options.
void move_with(const std::vector<Contact>& contacts, EnsembleOptions& options);

}  // namespace anholon
