// [simulate]: end, rows, tolerance, form and integrator of a run.
#pragma once
#include "modelfile/names/names.h"

namespace anholon {

void read_simulate(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics);

}  // namespace anholon
