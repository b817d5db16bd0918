// --show: a look at one stage of the main line.
#pragma once
#include "cli/commands.h"
#include "run/scenario.h"

namespace anholon::cli {

// Prints the stage named by o.show: mechanics, system, structure or program.
int show(const Options& o, const Scenario& s);

}  // namespace anholon::cli
