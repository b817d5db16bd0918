// The units of all named quantities of a model: columns of rows, columns of contacts, parameters.
#pragma once
#include <map>

#include "mechanics/conserved.h"
#include "modelfile/contacts.h"

namespace anholon {

// Returns the units by name: {"x'": "m/s", "floor.normal": "N", "k": "N/m"}, as far as the model has them. That of a
// parameter is the unit that the file declares for it.
std::map<std::string, std::string> quantity_units(const Model& model, const std::vector<Contact>& contacts);

// Adds the units of integrals of the motion, each under "conserved " and its name, to units by name.
void add_units(const Model& model, const std::vector<Conserved>& conserved, std::map<std::string, std::string>& units);

}  // namespace anholon
