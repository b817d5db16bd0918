// Tables that must not be left, for functions of states.
//
// A motion ends where the argument of such a table leaves its knots, so in the equations of a motion the table may go on
// along its tangents. A function of states has no value there:
//   c(x) + log(1 where x0 <= x <= xn, else -1)  replaces each coefficient c(x) of the table.
#pragma once
#include "setup/scenario.h"

namespace anholon {

// Replaces the coefficients of these tables (Model::bounds) in all expressions of the workspace.
void put_ends_of_tables(Workspace& workspace);

}  // namespace anholon
