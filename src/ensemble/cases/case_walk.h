// A plain case of an ensemble, step by step in a lane of a kernel.
//
// The case is computed by the tapes of the plan: parameters, consistent positions and velocities, the stepping program,
// events, outputs. No expressions are built, so all threads share one graph.
#pragma once
#include "ensemble/cases/ensemble_plan.h"
#include "ensemble/reduce/reducer.h"
#include "integrate/lanes/ordinary_steps.h"
#include "simulation/event_paces.h"
#include "simulation/followed_value.h"
#include "structure/start_memory.h"

namespace anholon {

// The way to compute a case: plainly, by the tapes of the plan; or in a workspace of its own, by `simulate`, with the
// program of the scenario or with one that is derived anew.
enum class CaseWay : std::uint8_t { plain, simulation, derivation };

// Computes plain cases one after the other, in one lane of a kernel.
class CaseWalk {
 public:
  using W = Wider<double>;

  // Begins the next case with its numbers and its consistent start. Returns the way in which the case has to be
  // computed; afterwards `walking` is true if it is plain and has steps to make.
  CaseWay begin(const EnsemblePlan& plan, CaseResult& result, const std::shared_ptr<Kernel>& kernel, int lane);
  bool walking() const { return result_ != nullptr; }
  void abandon() { result_ = nullptr, ready_ = false, stepper_.reset(); }
  CaseResult& result() const { return *result_; }
  const EnsembleCase& numbers() const { return numbers_; }
  // The parts of one step, as in Stepper::step; the kernel works between them. A case that is not walking after one of
  // the parts is done, or has to be computed in the way that the part returns.
  CaseWay begin_step();
  CaseWay aim();
  CaseWay look_at_end();
  bool looks_elsewhere() const { return looks_elsewhere_; }
  CaseWay finish_step();
  // Makes a whole step, alone in its kernel.
  CaseWay step();
  // The motion for OrdinarySteps; while its steps are ordinary, none of these parts is called.
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
  bool looks_elsewhere_ = false;                // the step has to end at another time
  W end_{0};
  std::vector<W> times_;                  // of rows
  std::optional<StartMemory<W>> starts_;  // for these parameters
  InitialState<W> named_;
  struct Lane {
    std::shared_ptr<Kernel> kernel{};
    int number = 0;
  } lane_;
  std::unique_ptr<Stepper<double>> stepper_;
  std::optional<Expansion<W>> point_;
  std::optional<Machine<W>> outputs_;
  std::optional<Reducer> reducer_;
  std::optional<EventPaces<W>> paces_;
  std::optional<TaylorWatch> watch_;
};

}  // namespace anholon
