// One motion: from the consistent state to the rows of a table, with its residual report.
#pragma once
#include "observe/options.h"
#include "observe/report.h"
#include "result/rows.h"

namespace anholon {

SimulationReport simulate(const Scenario& scenario, const SimulationOptions& options, RowSink& sink);
// As above, in a workspace of the caller, in whose graph expressions are added.
SimulationReport simulate_in(Workspace& scenario, const SimulationOptions& options, RowSink& sink);

}  // namespace anholon
