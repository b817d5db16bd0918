// What threads do with the cases of an ensemble.
//
// The plain way reads tapes that were compiled before: parameters, consistent positions and velocities, the stepping
// program, outputs. It builds no expressions, so all threads share one graph. It only finishes: what stops on the way,
// or needs events, completed states, redundant constraints or another elimination, goes the way of `simulate` in a
// workspace of the case, so that its outcome is that of `simulate`. A case with which the equations have another
// structure is derived anew.
#pragma once
#include <deque>
#include <mutex>

#include "ensemble/case_parameters.h"
#include "ensemble/case_scenario.h"
#include "ensemble/columns.h"
#include "kernel/kernel.h"
#include "motion/code_for_long_runs.h"

namespace anholon {

// Read by all threads, changed by none.
class EnsemblePlan {
 public:
  EnsemblePlan(const Scenario& scenario, const EnsembleOptions& options);

  const Scenario& of_all;  // as it was given
  const EnsembleOptions& options;
  Workspace scenario;  // in which the plan was made; frozen
  bool plain = false;  // the plain way goes for this model
  std::optional<StartPlan> start;
  CaseParameters parameters;
  std::vector<Node> entries;       // of the state, in the order of an Expansion's
  std::optional<Program> program;  // varying masses are its quadratures
  // For the expansions of all cases, its pivots chosen at the start of the scenario; may be null. `simulate` chooses
  // them at its own start, so the last digits may differ. Machine code, with the same bits, is made beside the cases
  // when they have taken a while.
  std::shared_ptr<const KernelPlan> kernel;
  void compile_if_long() const;
  int lanes = 1;  // of kernels of cases: all that this machine has
  std::optional<Tape> outputs;
  struct Entry {
    std::uint32_t slot;
    std::optional<std::size_t> variable;  // else t
    int order;
  };
  std::vector<Entry> output_inputs;
  int stages = 0;
  bool leading = false;  // what is kept of a case needs more than its state
  StepSettings settings;

 private:
  void make();

  mutable std::mutex compiling_;
  mutable CodeForLongRuns code_;
};

// How a case is computed: by the tapes of the plan, or in a workspace of its own, by the program of the scenario or one
// that is derived anew.
enum class CaseWay : std::uint8_t { plain, simulation, derivation };

// The plain way of one case after the other, in one lane of a kernel.
class CaseWalk {
 public:
  using W = Wider<double>;

  // The next case: its numbers, its consistent start. The way it has to go; `walking` if this one has steps to make.
  CaseWay begin(const EnsemblePlan& plan, CaseResult& result, const std::shared_ptr<Kernel>& kernel, int lane);
  bool walking() const { return result_ != nullptr; }
  void abandon() { result_ = nullptr, ready_ = false; }
  CaseResult& result() const { return *result_; }
  const EnsembleCase& numbers() const { return numbers_; }
  // One step, in the parts of Stepper::step; the kernel works in between. Whoever stops walking after one of them has
  // come to its end on the way it returns.
  CaseWay begin_step();
  CaseWay aim();
  CaseWay look_at_end();
  bool looks_elsewhere() const { return looks_elsewhere_; }
  CaseWay finish_step();
  // The whole step, alone in its kernel.
  CaseWay step();

 private:
  CaseWay after_step();
  CaseWay stopped(const Outcome& why);
  CaseWay stop(CaseWay way);
  bool rows();
  bool keep(const W& t, std::vector<double>& values);

  const EnsemblePlan* plan_ = nullptr;
  CaseResult* result_ = nullptr;
  EnsembleCase numbers_;
  std::vector<W> parameters_;
  std::vector<double> narrow_parameters_;
  bool ready_ = false, same_structure_ = true;  // for these parameters
  bool looks_elsewhere_ = false;                // the step is to end somewhere else
  W end_{0};
  std::vector<W> times_;  // of rows
  InitialState<W> named_;
  std::optional<Stepper<double>> stepper_;
  std::optional<Expansion<W>> point_;
  std::optional<Machine<W>> outputs_;
};

// The workspaces of one thread.
class CaseWorker {
 public:
  explicit CaseWorker(const EnsemblePlan& plan) : plan_(plan) {}

  // These cases, whose numbers stand in the results.
  void integrate(std::span<CaseResult> results);
  std::size_t in_workspaces() const { return in_workspaces_; }

 private:
  using W = Wider<double>;

  void end(CaseWay way, const EnsembleCase& numbers, CaseResult& result);
  void by_simulation(const EnsembleCase& numbers, CaseResult& result);
  void by_derivation(const EnsembleCase& numbers, CaseResult& result);
  void simulate_case(Workspace& own, const EnsembleCase& numbers, CaseResult& result);

  const EnsemblePlan& plan_;
  std::shared_ptr<Kernel> kernel_;
  std::deque<CaseWalk> walks_;  // one for each lane
  std::size_t in_workspaces_ = 0;
};

}  // namespace anholon
