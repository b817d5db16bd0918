// [gravity], [potential], [dissipation].
#pragma once
#include "modelfile/names/names.h"

namespace anholon {

void read_gravity(const Item& root, Scope& scope, Diagnostics& diagnostics);
void read_potentials(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics);
void read_dissipation(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics);

}  // namespace anholon
