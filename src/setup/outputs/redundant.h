// Constraints that are left out because they follow from the others: checks that they still follow, and computes their
// multipliers. The choice of the constraints that are left out belongs to a point: a motion may choose others later
// (motion/motion.h).
#pragma once
#include "setup/outputs/output_tape.h"

namespace anholon {

template <Number W>
class Redundant {
 public:
  Redundant(Workspace& scenario, const std::vector<W>& parameters);

  bool any() const { return outputs_.has_value(); }
  // The residual of a constraint that is left out at a point, relative to the size of the state.
  struct Miss {
    std::size_t constraint = 0;  // index in the model
    double miss = 0;
  };
  // Fails if a constraint that is left out does not hold at a point of the motion. If the point is the start, the
  // constraints contradict one another.
  Outcome hold(const Expansion<W>& point, bool start, std::vector<Miss>& misses);
  // Returns the multipliers of all constraints of the model, with the same N: the least ones if multipliers are not
  // part of the state, else zeros for the constraints that are left out (theory: dae-view).
  std::vector<W> multipliers(const Expansion<W>& point);
  // Returns the dependencies at the last point of which the least multipliers were computed; none before.
  UndeterminedMultipliers undetermined() const { return least_ ? least_->undetermined() : UndeterminedMultipliers(); }

  void set_parameters(const std::vector<W>& parameters) {
    if (outputs_) outputs_->set_parameters(parameters), least_->set_parameters(parameters);
  }

 private:
  const Scenario& s_;
  std::optional<OutputTape<W>> outputs_;  // the constraints; nullopt if none is redundant
  std::optional<LeastMultipliers<W>> least_;
};

// Fails if a constraint that is left out at the start of a motion does not follow from the others near the start, which
// the series of the motion by the other constraints shows. This happens if rows are dependent at this one point only,
// or if constraints that agree in their highest derivatives require more together (x' + y' = 0 and x' + y' + z = 0).
Outcome follow_beside_start(Workspace& s);

extern template class Redundant<long double>;
extern template class Redundant<Quad>;
extern template class Redundant<Multi>;

}  // namespace anholon
