// Checks that the units of a file are consistent. Every name gets a dimension, known from a unit or an unknown of Q^7,
// and every formula and element gives relations between dimensions: terms of a sum have one dimension, x' has that of x
// divided by a second, a position is a length. A bare number has any dimension. A file without units is always
// accepted: its formulas may contradict one another, for example if they have scaled quantities; but a value with a
// unit from outside (--set) must not contradict them.
#pragma once
#include <map>

#include "modelfile/mechanical/contacts.h"

namespace anholon {

// Reports clashes. Stores the inferred units in the model and in its contacts, and the scales of the unknowns, which
// follow from the formulas also in a file without units. REQUIRES: the file has no errors.
void check_dimensions(const Item& root, const Scope& scope, Model& model, std::vector<Contact>& contacts,
                      Diagnostics& diagnostics);
// Returns the units of the coordinates and parameters of a file without units, as far as they follow from its formulas:
// a position is a length. Empty if the formulas contradict one another.
std::map<std::string, std::string> implied_units(const Item& root, const Scope& scope, const Model& model);

}  // namespace anholon
