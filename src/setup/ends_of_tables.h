// Tables that must not be left, for functions of states.
//
// A motion ends where the argument of such a table leaves its knots, so in the equations of a motion the table may go on
// along its tangents. A function of states has no value there:
//   c(x) + log(1 where x0 <= x <= xn, else -1)  replaces each coefficient c(x) of the table.
#pragma once
#include "setup/scenario.h"

namespace anholon {

// Returns expressions in the graph of the model in which the coefficients of these tables (Model::bounds) are replaced.
Column with_ends_of_tables(const Model& model, const Column& es);
// Replaces the coefficients in all expressions of the workspace.
void put_ends_of_tables(Workspace& workspace);

}  // namespace anholon
