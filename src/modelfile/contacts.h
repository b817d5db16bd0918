// The contacts of a model file that has been opened.
#pragma once
#include "modelfile/mechanical/contacts.h"

namespace anholon {

// names: those of open_model(). The expressions belong to the graph of its model.
const std::vector<Contact>& contacts(const Names& names);

// The model of the names, whose holder may put a mode of the contacts into it; no thread may read it meanwhile.
Model& model_of(Names& names);

}  // namespace anholon
