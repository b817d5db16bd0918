// [initial]: values, guesses and conditions, in each of the accepted spellings.
#pragma once
#include "modelfile/names/names.h"

namespace anholon {

void read_initial(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics);

}  // namespace anholon
