// One motion: from the consistent state to the rows of a table, with its residual report.
#pragma once
#include "motion/motion.h"
#include "observe/options.h"
#include "observe/report.h"
#include "result/rows.h"

namespace anholon {

SimulationReport simulate(const Scenario& scenario, const SimulationOptions& options, RowSink& sink);
// As above, in a workspace of the caller, in whose graph expressions are added. plans: those of the motion in doubles before
// this one, in the same workspace with the same tolerance and order, and then those of this one; empty ones are made.
SimulationReport simulate_in(Workspace& scenario, const SimulationOptions& options, RowSink& sink,
                             MotionPlans* plans = nullptr);

}  // namespace anholon
