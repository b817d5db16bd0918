// What threads do with the cases of an ensemble.
//
// The plain way reads tapes that were compiled before: parameters, consistent positions and velocities, the stepping program,
// outputs. It builds no expressions, so all threads share one graph. It only finishes: what stops on the way, or needs events,
// completed states, redundant constraints or another elimination, goes the way of `simulate` in a graph of the thread's own, so that its
// outcome is that of `simulate`.
#pragma once
#include "run/ensemble.h"

namespace anholon {

// Read by all threads, changed by none.
class EnsemblePlan {
 public:
  EnsemblePlan(const Scenario& scenario, const EnsembleOptions& options);

  const Scenario& scenario;
  const EnsembleOptions& options;
  bool plain = false;               // the plain way goes for this model
  std::optional<StartPlan> start;
  Tape parameters;                  // of all parameters by those that are varied
  std::vector<Node> entries;        // of the state, in the order of an Expansion's
  std::optional<Program> program;   // varying masses are its quadratures
  std::optional<Tape> outputs;
  struct Entry {
    std::uint32_t slot;
    std::optional<std::size_t> variable;  // else t
    int order;
  };
  std::vector<Entry> output_inputs;
  int stages = 0;
  StepSettings settings;
};

// The workspaces of one thread.
class CaseWorker {
 public:
  explicit CaseWorker(const EnsemblePlan& plan) : plan_(plan) {}

  // These cases, whose numbers stand in the results.
  void integrate(std::span<CaseResult> results);
  std::size_t again() const { return again_; }

 private:
  using W = Wider<double>;
  struct Own;  // a graph of its own

  bool plainly(const EnsembleCase& numbers, CaseResult& result);
  bool set_parameters(const EnsembleCase& numbers);
  bool walk(const W& t, const std::vector<W>& state, const EnsembleCase& numbers, CaseResult& result);
  bool keep(const W& t, std::vector<double>& values);
  void by_simulation(const EnsembleCase& numbers, CaseResult& result);
  void simulate_in(Own& own, const Rational& to, std::vector<StateOverride> overrides, CaseResult& result);
  std::shared_ptr<Own> make_own();

  const EnsemblePlan& plan_;
  std::vector<W> parameters_, given_;
  std::vector<double> narrow_parameters_;
  InitialState<W> named_;
  std::optional<Stepper<double>> stepper_;
  std::optional<Expansion<W>> point_;
  std::optional<Machine<W>> outputs_;
  std::shared_ptr<Own> own_;
  std::size_t again_ = 0;
};

}  // namespace anholon
