// The contacts of a model file that has been opened, and what has to hold for its parameters.
#pragma once
#include "modelfile/mechanical/contacts.h"

namespace anholon {

// Returns the contacts. `names` are those of open_model(). The expressions belong to the graph of its model.
const std::vector<Contact>& contacts(const Names& names);

// Returns the model of the names, in which the caller may set a mode of the contacts; no thread may read it meanwhile.
Model& model_of(Names& names);

// Returns the identities that have to hold for all numbers of the parameters.
const std::vector<Identity>& identities(const Names& names);

}  // namespace anholon
