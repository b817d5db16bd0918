// Computes one motion: from the consistent state to the rows of a table, with its residual report.
#pragma once
#include "motion/motion.h"
#include "observe/options.h"
#include "observe/report.h"
#include "result/rows.h"

namespace anholon {

class WaitingRows;

// The data that one motion in doubles passes to the next one in the same workspace.
struct SimulationPlans {
  MotionPlans motion;
  std::optional<std::shared_ptr<WaitingRows>> rows;  // nullptr if rows need the reference
};

SimulationReport simulate(const Scenario& scenario, const SimulationOptions& options, RowSink& sink);
// Like simulate(), in a workspace of the caller, to whose graph expressions are added. `plans`: on entry what the
// motion in doubles before this one left, in the same workspace, with the same tolerance, order and conserved
// quantities; on return what this one leaves.
SimulationReport simulate_in(Workspace& scenario, const SimulationOptions& options, RowSink& sink,
                             SimulationPlans* plans = nullptr);

}  // namespace anholon
