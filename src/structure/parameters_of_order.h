// Parameters whose values decide the order of the equations: a mass that is 0, the coefficient of a highest derivative.
#pragma once
#include "structure/structure.h"

namespace anholon {

// Returns the parameters that do not follow from others and whose values remove terms with derivatives from the system
// that the structure would otherwise count, or let constraints vanish identically. With another value of one of them the equations have another state. The
// mechanics and the elimination are those from which the system was made, in the same graph.
std::vector<std::size_t> parameters_of_order(const Mechanics& mechanics, const Elimination& elimination,
                                             const System& system, const Structure& structure);

}  // namespace anholon
