// --show: prints one stage of the derivation.
#pragma once
#include "cli/input.h"

namespace anholon::cli {

// Prints the stage named by o.show: mechanics, system, structure or program.
int show(const SystemCommand& o, const Scenario& s, const Outcome& outcome = {});

// Prints the cost of an expansion in each form and writing (`check --show cost`).
int show_cost(const SystemCommand& o, const Reader& in);

}  // namespace anholon::cli
