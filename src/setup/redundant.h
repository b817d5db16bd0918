// Constraints that were left out because they follow from the others: whether they go on to do so, and their
// multipliers.
#pragma once
#include "setup/scenario.h"

namespace anholon {

template <Number W>
class Redundant {
 public:
  Redundant(Workspace& scenario, const std::vector<W>& parameters);

  bool any() const { return outputs_.has_value(); }
  // Not ok if one no longer holds at a point of the motion; `worst` is the largest miss, in relation to the state.
  // Where the point is the start the constraints contradict one another.
  Outcome hold(const Expansion<W>& point, bool start, double& worst);
  // Of all constraints of the model, with the same N: the least ones, where multipliers are not part of the state, else
  // zeros for what was left out (theory: dae-view).
  std::vector<W> multipliers(const Expansion<W>& point);

  void set_parameters(const std::vector<W>& parameters) {
    if (outputs_) outputs_->set_parameters(parameters);
  }

 private:
  Column expressions() const;

  const Scenario& s_;
  std::optional<OutputTape<W>> outputs_;  // where there are any
};

extern template class Redundant<long double>;
extern template class Redundant<Quad>;
extern template class Redundant<Multi>;

}  // namespace anholon
