// The data that all cases of an ensemble share: compiled tapes and settings.
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

  const Scenario& of_all;  // the given scenario
  const EnsembleOptions& options;
  Workspace scenario;  // the frozen workspace in which the plan was made
  bool plain = false;  // cases of this model may be plain
  std::optional<StartPlan> start;
  CaseParameters parameters;
  std::vector<Node> entries;       // of the state, in the order of an Expansion
  std::optional<Program> program;  // the varying masses are its quadratures
  // The kernel plan for the expansions of all cases; nullptr if there is none. Its pivots are chosen at the start of
  // the scenario, those of `simulate` at the start of the case, so the last digits may differ. Machine code with the
  // same bits is made beside the cases when these have taken a while.
  std::shared_ptr<const KernelPlan> kernel;
  mutable SweepLanes lanes;  // the lanes of the kernels of cases
  // The formulas of the reductions among the program's quadratures. For each formula: the functions in it that may hide
  // their variation, and the quadratures that are their arguments.
  struct Reduced {
    struct Function {
      Hiding hiding;
      std::size_t argument;
    };
    std::size_t first = 0;
    std::vector<std::vector<Function>> functions;
  } reduced;
  std::vector<WatchedSeries> watched;
  std::vector<std::optional<SetByEvent>> sets;       // for each event, if it sets something
  std::optional<NearestState<long double>> nearest;  // with constraints, if an event sets something
  struct Outputs {
    Tape tape;  // the monitors, then the ends of the reductions
    struct Entry {
      std::uint32_t slot;
      std::optional<std::size_t> variable;  // nullopt: t
      int order;
    };
    std::vector<Entry> inputs;
  };
  std::optional<Outputs> outputs;
  std::optional<RatesOnDemand> rates;  // if a method other than Taylor's may compute a case
  int stages = 0;
  int highest = 0;       // the highest derivative of a coordinate in a row of `simulate`
  bool leading = false;  // the results of a case need more than its state
  StepSettings settings;

 private:
  void make();
};

}  // namespace anholon
