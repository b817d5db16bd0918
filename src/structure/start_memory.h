// The machines of a start plan with one set of parameters, kept for many states that differ in their overrides.
//
// A stage computes again only results that depend on inputs with other bits than at the state before (Stage::evaluate),
// so the states have the bits that they have without a memory. One thread at a time may use a memory.
#pragma once
#include <memory>
#include <vector>

#include "base/outcome.h"
#include "structure/initial_problem.h"

namespace anholon {

// Temporary values of the solver of a state, kept from one state to the next so that their lists keep their storage.
template <Number N>
struct StartNotes {
  InitialState<N> at_first, before;    // the state before all attempts, and before the present one
  std::vector<std::size_t> free, all;  // unknowns of a stage
};

template <Number N>
class StartMemory {
 public:
  // REQUIRES: the mechanics and the plan outlive the memory.
  StartMemory(const Mechanics& m, const StartPlan& plan, const std::vector<N>& parameters)
      : values_(plan.values, 0, parameters) {
    values_.evaluate();
    if (plan.state_rates) rates_.emplace(*plan.state_rates, 0, parameters);
    for (const StartPlan::Stages& s : {plan.positions, plan.velocities, plan.both})
      if (s) stages_.push_back({s.get(), std::make_unique<Stage<N>>(m, s, parameters)});
  }

  const Machine<N>& values() const { return values_; }
  Machine<N>* rates() { return rates_ ? &*rates_ : nullptr; }
  StartNotes<N>& notes() { return notes_; }
  // Returns nullptr if the stage does not belong to the plan.
  Stage<N>* stage(const StartPlan::Stages& of) {
    for (Known& k : stages_)
      if (k.plan == of.get()) {
        k.stage->keep_all();
        return k.stage.get();
      }
    return nullptr;
  }

 private:
  struct Known {
    const StagePlan* plan;
    std::unique_ptr<Stage<N>> stage;
  };
  Machine<N> values_;
  std::optional<Machine<N>> rates_;  // of the model's states
  StartNotes<N> notes_;
  std::vector<Known> stages_;
};

// Computes what consistent_state() of consistent.h computes, with a memory for the plan of the problem and its
// parameters.
template <Number N>
Outcome consistent_state(const InitialProblem<N>& problem, StartMemory<N>& memory, InitialState<N>& state);

}  // namespace anholon
