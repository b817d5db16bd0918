// [view]: the picture of a model.
#pragma once
#include "modelfile/names/names.h"

namespace anholon {

// Reads the section, and stores the named points. REQUIRES: the bodies are known.
void read_view(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics);

}  // namespace anholon
