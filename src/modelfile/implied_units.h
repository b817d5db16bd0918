// Units that follow from the formulas of a file without units, for values with a unit that are given beside the file.
#pragma once
#include <map>
#include <string>

#include "model/model.h"

namespace anholon {

// Returns the SI unit of each coordinate and parameter whose unit follows: {"x": "m", "m": "kg"}. Reads the text of the
// model again, without its cases. Empty if the text cannot be read or its formulas contradict one another.
std::map<std::string, std::string> implied_units(const Model& model);

}  // namespace anholon
