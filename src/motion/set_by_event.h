// Evaluates what one event sets: its formulas as numbers, compiled once for all motions with the same unknowns.
#pragma once
#include "program/expansion.h"
#include "setup/scenario.h"

namespace anholon {

// A number that an event has changed.
template <Number W>
struct ChangeByEvent {
  std::string name;
  W before{0}, after{0};
};

class SetByEvent {
 public:
  // Builds expressions in the workspace.
  SetByEvent(Workspace& scenario, const Event& event);

  // Computes the new numbers from the present state and parameters, and, for what is not in the state, from `point`,
  // the solution where the event fires; then writes them into the state and the parameters. Fails if a target does not
  // belong to the state, or a formula has no value.
  template <Number W>
  Outcome put(const Expansion<W>& point, std::vector<W>& state, std::vector<W>& parameters,
              std::vector<ChangeByEvent<W>>& changes) const;

 private:
  // A symbol: the time, a parameter, a derivative of an unknown, or 0 for the multiplier of a redundant constraint.
  struct Place {
    enum class Kind : std::uint8_t { time, parameter, unknown, zero } kind = Kind::zero;
    std::size_t index = 0;
    int order = 0;
  };
  static Place place(const System& system, const Graph& graph, NodeId symbol);
  template <Number W>
  static W* entry(const Place& place, const Expansion<W>& point, std::vector<W>& state, std::vector<W>& parameters);
  // Computes the solution at `point` with all orders that the formulas contain, in `more`; leaves it empty if `point`
  // has them by its leading derivatives.
  template <Number W>
  Outcome with_all_orders(const Expansion<W>& point, std::optional<Expansion<W>>& more) const;

  std::string event_;
  Tape tape_;
  std::vector<std::pair<std::uint32_t, Place>> inputs_;  // slots of the tape
  struct Target {
    std::string name;
    Place place;
  };
  std::vector<Target> targets_;
};

}  // namespace anholon
