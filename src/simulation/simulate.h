// One motion: from the consistent state to the rows of a table, with its residual report.
#pragma once
#include "observe/options.h"
#include "observe/report.h"
#include "result/rows.h"

namespace anholon {

SimulationReport simulate(const Scenario& scenario, const SimulationOptions& options, RowSink& sink);
// The same in a workspace that the caller gives, and which has grown afterwards.
SimulationReport simulate_in(Workspace& scenario, const SimulationOptions& options, RowSink& sink);

}  // namespace anholon
