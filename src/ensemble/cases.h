// The computation of the cases of an ensemble on many threads.
//
// A plain case is computed by tapes that were compiled before: parameters, consistent positions and velocities, the
// stepping program, events, outputs. It builds no expressions, so all threads share one graph. A case that stops other than
// by an event, or needs completed states, redundant constraints or another elimination, is computed by `simulate` in a
// workspace of its own, so its outcome is that of `simulate`. A case in which the equations have another structure is derived anew.
#pragma once
#include <deque>
#include <map>

#include "ensemble/case_parameters.h"
#include "ensemble/case_scenario.h"
#include "ensemble/columns.h"
#include "ensemble/lanes/sweep_lanes.h"
#include "integrate/lanes/ordinary_steps.h"
#include "kernel/kernel.h"
#include "motion/method_choice.h"
#include "motion/motion.h"
#include "simulation/event_paces.h"
#include "simulation/followed_value.h"
#include "structure/start_memory.h"

namespace anholon {

// The tapes and settings that all threads read and none changes.
class EnsemblePlan {
 public:
  EnsemblePlan(const Scenario& scenario, const EnsembleOptions& options);

  const Scenario& of_all;  // as it was given
  const EnsembleOptions& options;
  Workspace scenario;  // in which the plan was made; frozen
  bool plain = false;  // whether cases of this model may be plain
  std::optional<StartPlan> start;
  CaseParameters parameters;
  std::vector<Node> entries;       // of the state, in the order of an Expansion's
  std::optional<Program> program;  // varying masses are its quadratures
  // The kernel plan for the expansions of all cases; null if there is none. Its pivots are chosen at the start of the
  // scenario, those of `simulate` at the start of the case: the last digits may differ. Machine code with the same bits
  // is made beside the cases when these have taken a while.
  std::shared_ptr<const KernelPlan> kernel;
  mutable SweepLanes lanes;       // of the kernels of cases
  std::size_t first_reduced = 0;  // of the program's quadratures
  std::vector<WatchedSeries> watched;
  std::vector<std::optional<SetByEvent>> sets;       // of each event, if it sets something
  std::optional<NearestState<long double>> nearest;  // with constraints, if an event sets something
  struct Outputs {
    Tape tape;  // of the monitors, then of the ends of the reductions
    struct Entry {
      std::uint32_t slot;
      std::optional<std::size_t> variable;  // nullopt: t
      int order;
    };
    std::vector<Entry> inputs;
  };
  std::optional<Outputs> outputs;
  std::optional<RatesOnDemand> rates;  // if a method other than Taylor's may make a case
  int stages = 0;
  int highest = 0;       // derivative of a coordinate that a row of `simulate` has
  bool leading = false;  // whether the results of a case need more than its state
  StepSettings settings;

 private:
  void make();
};

// How a case is computed: plainly, by the tapes of the plan; or in a workspace of its own, by `simulate` with the
// program of the scenario, or with one that is derived anew.
enum class CaseWay : std::uint8_t { plain, simulation, derivation };

// Computes one plain case after the other, in one lane of a kernel.
class CaseWalk {
 public:
  using W = Wider<double>;

  // Begins the next case with its numbers and its consistent start. Returns the way in which it has to be computed;
  // `walking` tells whether it is plain and has steps to make.
  CaseWay begin(const EnsemblePlan& plan, CaseResult& result, const std::shared_ptr<Kernel>& kernel, int lane);
  bool walking() const { return result_ != nullptr; }
  void abandon() { result_ = nullptr, ready_ = false, stepper_.reset(); }
  CaseResult& result() const { return *result_; }
  const EnsembleCase& numbers() const { return numbers_; }
  // One step, in the parts of Stepper::step; the kernel works between them. A case that is not walking after one of the
  // parts is done, or has to be computed in the way that the part returns.
  CaseWay begin_step();
  CaseWay aim();
  CaseWay look_at_end();
  bool looks_elsewhere() const { return looks_elsewhere_; }
  CaseWay finish_step();
  // The whole step, alone in its kernel.
  CaseWay step();
  // As long as its steps are ordinary, the motion needs none of these parts.
  OrdinarySteps::Motion motion() const;

 private:
  void equip(const std::vector<W>& parameters, const std::vector<double>& narrow);
  CaseWay after_step();
  CaseWay arrive();
  CaseWay take_events();
  CaseWay stopped(const Outcome& why);
  CaseWay stop(CaseWay way);
  bool another_method_pays();
  bool reduce();
  bool rows();
  bool keep(const W& t, std::vector<double>& values);
  void tell_ends();

  const EnsemblePlan* plan_ = nullptr;
  CaseResult* result_ = nullptr;
  EnsembleCase numbers_;
  std::vector<W> parameters_;
  std::vector<double> narrow_parameters_;
  bool ready_ = false, same_structure_ = true;  // for these parameters
  bool looks_elsewhere_ = false;                // whether the step has to end at another time
  W end_{0};
  std::vector<W> times_;                  // of rows
  std::optional<StartMemory<W>> starts_;  // for these parameters
  InitialState<W> named_;
  std::shared_ptr<Kernel> kernel_;
  int lane_ = 0;
  std::unique_ptr<Stepper<double>> stepper_;
  std::optional<Expansion<W>> point_;
  std::optional<Machine<W>> outputs_;
  std::optional<Reducer> reducer_;
  HidingSlots hiding_;  // of the formulas of the reductions
  std::optional<EventPaces<W>> paces_;
  std::optional<TaylorWatch> watch_;
};

// The workspaces of one thread.
class CaseWorker {
 public:
  explicit CaseWorker(const EnsemblePlan& plan) : plan_(plan) {}

  // Computes the cases with the numbers that the results hold.
  void integrate(std::span<CaseResult> results);
  std::size_t in_workspaces() const { return in_workspaces_; }

 private:
  using W = Wider<double>;

  // A kernel, and a case in each of its lanes.
  struct Together {
    std::shared_ptr<Kernel> kernel{};
    std::optional<OrdinarySteps> ordinary{};
    std::deque<CaseWalk> walks{};
  };
  Together& together(int lanes);
  void integrate(Together& together, std::span<CaseResult> results);
  void end(CaseWay way, const EnsembleCase& numbers, CaseResult& result);
  void by_simulation(const EnsembleCase& numbers, CaseResult& result);
  void by_derivation(const EnsembleCase& numbers, CaseResult& result);
  void simulate_case(Workspace& own, const EnsembleCase& numbers, CaseResult& result);

  const EnsemblePlan& plan_;
  std::map<int, Together> together_;  // number of lanes -> the kernel with so many
  std::size_t in_workspaces_ = 0;
};

}  // namespace anholon
