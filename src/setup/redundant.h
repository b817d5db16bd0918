// Constraints that are left out because they follow from the others: whether they go on to do so, and their
// multipliers. Which are left out belongs to a point: a motion may choose others on its way (motion/motion.h).
#pragma once
#include "setup/output_tape.h"

namespace anholon {

template <Number W>
class Redundant {
 public:
  Redundant(Workspace& scenario, const std::vector<W>& parameters);

  bool any() const { return outputs_.has_value(); }
  // By how much each constraint that is left out at a point is missed there, in relation to the state.
  struct Miss {
    std::size_t constraint = 0;  // of the model
    double miss = 0;
  };
  // Not ok if one no longer holds at a point of the motion. Where the point is the start the constraints contradict one
  // another.
  Outcome hold(const Expansion<W>& point, bool start, std::vector<Miss>& misses);
  // Of all constraints of the model, with the same N: the least ones, where multipliers are not part of the state, else
  // zeros for what was left out (theory: dae-view).
  std::vector<W> multipliers(const Expansion<W>& point);

  void set_parameters(const std::vector<W>& parameters) {
    if (outputs_) outputs_->set_parameters(parameters), least_->set_parameters(parameters);
  }

 private:
  const Scenario& s_;
  std::optional<OutputTape<W>> outputs_;  // the constraints, where there are any
  std::optional<LeastMultipliers<W>> least_;
};

// Whether the constraints that are left out at the start of a motion follow from the others beside it, too: by the series
// of the motion that the others make. They do not where rows are dependent at this one point, or where constraints that
// agree in their highest derivatives ask for more together (x' + y' = 0 and x' + y' + z = 0).
Outcome follow_beside_start(Workspace& s);

extern template class Redundant<long double>;
extern template class Redundant<Quad>;
extern template class Redundant<Multi>;

}  // namespace anholon
