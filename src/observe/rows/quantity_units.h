// The units of all quantities of a model that have a name: columns of rows, columns of contacts, parameters.
#pragma once
#include <map>

#include "modelfile/contacts.h"

namespace anholon {

// By name: {"x'": "m/s", "floor.normal": "N", "k": "N/m"}, as far as the model tells them.
std::map<std::string, std::string> quantity_units(const Model& model, const std::vector<Contact>& contacts);

}  // namespace anholon
