// Checks that the units of a file are consistent. Every name gets a dimension, known from a unit or an unknown of Q^7,
// and every formula and element gives relations between dimensions: terms of a sum have one dimension, x' has that of x
// divided by a second, a position is a length. A bare number has any dimension, so a file without units is always
// consistent. In such a file formulas may contradict one another, as those with scaled quantities do; a value with a unit
// from outside (--set) may not.
#pragma once
#include <map>

#include "modelfile/mechanical/contacts.h"

namespace anholon {

// Reports clashes, and stores the units that were found in the model and in its contacts, and the scales of the unknowns,
// which follow from the formulas also in a file without units. The file must have no errors.
void check_dimensions(const Item& root, const Scope& scope, Model& model, std::vector<Contact>& contacts,
                      Diagnostics& diagnostics);
// The units of the coordinates and parameters of a file without units, as far as they follow from its formulas: a position
// is a length. Empty if the formulas contradict one another.
std::map<std::string, std::string> implied_units(const Item& root, const Scope& scope, const Model& model);

}  // namespace anholon
