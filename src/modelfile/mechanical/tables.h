// [[table]]: functions given by values at knots, in the file or in columns of another file.
#pragma once
#include "modelfile/names/names.h"

namespace anholon {

void declare_tables(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics);

}  // namespace anholon
