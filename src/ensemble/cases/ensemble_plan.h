// What the cases of an ensemble share: tapes that were compiled before, and settings.
#pragma once
#include "ensemble/cases/case_parameters.h"
#include "ensemble/lanes/sweep_lanes.h"
#include "kernel/kernel.h"
#include "motion/method_choice.h"
#include "motion/motion.h"

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
  mutable SweepLanes lanes;  // of the kernels of cases
  // The formulas of the reductions among the program's quadratures. Of each: the functions in it that may hide their variation,
  // and the quadratures that are their arguments.
  struct Reduced {
    struct Function {
      Hiding hiding;
      std::size_t argument;
    };
    std::size_t first = 0;
    std::vector<std::vector<Function>> functions;
  } reduced;
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

}  // namespace anholon
