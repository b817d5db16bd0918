// --show: a look at one stage of the main line.
#pragma once
#include "cli/input.h"

namespace anholon::cli {

// Prints the stage named by o.show: mechanics, system, structure or program.
int show(const Options& o, const Scenario& s);

// What an expansion costs in the forms and writings that come into question (of check).
int show_cost(const Options& o, const Reader& in);

}  // namespace anholon::cli
