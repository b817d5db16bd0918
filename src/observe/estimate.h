// Estimates the global error of a run by a second, sharper run: at a tolerance 100 times smaller and two orders higher,
// in wider numbers if there are any; or by a kernel in doubles that rounds its coefficients otherwise, at the order of
// the run and a tolerance of at least 1e-14. The second run starts at a state that differs in its last digits if both
// runs would round the start alike. The runs are compared in every column, at rows all along the run. A motion that
// forgets its start (a double pendulum after a long time) shows as lost digits (theory: integrals).
#pragma once
#include "motion/motion.h"
#include "observe/options.h"
#include "observe/report.h"
#include "observe/rows/row_comparison.h"
#include "observe/rows/sampled_rows.h"
#include "observe/rows/waiting_rows.h"

namespace anholon {

// A moment at which an event fired.
template <Number W>
struct EventMoment {
  std::size_t event = 0;
  W t{0};
};

template <Number W>
struct RunToJudge {
  SampledRows<W> rows;
  std::vector<EventMoment<W>> events;
  std::vector<std::size_t> columns;  // the columns of a row that its values belong to; empty: all
  std::optional<W> since;            // events up to this time are not counted, because the run continues an earlier one
  bool knows_resets = true;          // if false, an event may have changed the state any number of times
  bool by_kernel = false;            // its expansions were made by a kernel in doubles
  // These may be set: the motion, whose plans the second run uses, the quadratures along the motion, and its rows.
  const Motion<double>* motion = nullptr;
  std::vector<Expr> quadratures = {};
  WaitingRows* waiting = nullptr;
  // If they are not set: on entry what the second run of another motion has left, in the same workspace and with the
  // same options; on return what this one leaves.
  struct Plans {
    MotionPlans motion;
    std::unique_ptr<WaitingRows> rows;
  };
  Plans* plans = nullptr;
};

// N: the number type of the run. Fills `error` or `no_error` of the report.
template <Number N>
void estimate_error(Workspace& scenario, const SimulationOptions& options, RunToJudge<Wider<N>>& run,
                    SimulationReport& report);

// The relative round-off of the numbers that a run writes.
template <Number N>
double written_roundoff(const SimulationOptions& options);

// Returns the differences of two rows; `outputs` belong to the sharper run.
template <Number W, class Outputs>
RowComparison::Row difference(const Scenario& s, double t, const std::vector<W>& run, const std::vector<W>& sharper,
                              const Outputs& outputs) {
  RowComparison::Row row{t, {}, {}, {}};
  const std::size_t n = sharper.size(), monitors = s.model->monitors.size();
  for (std::size_t j = 0; j < n; ++j) {
    row.differences.push_back(to_double(W(abs(W(run[j] - sharper[j])))));
    row.magnitudes.push_back(to_double(W(abs(sharper[j]))));
    row.terms.push_back(j + monitors < n ? row.magnitudes.back()
                                         : to_double(W(outputs.monitor_terms(j + monitors - n))));
  }
  return row;
}

}  // namespace anholon
