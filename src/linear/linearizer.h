// Linear models of a scenario at its initial state.
#pragma once
#include "linear/varied_equations.h"

namespace anholon {

class LinearPoint;

// The linearizer of a scenario. REQUIRES: the precision of the thread is that at the construction.
class Linearizer {
 public:
  Linearizer(Workspace& scenario, const StateChoice& choice, Signals signals = {});
  // Linearizes at other values of the parameters. The initial data are solved anew, from `near`, their solution in
  // double. Only if `check`, the steadiness of the motion is decided.
  Outcome at(const std::vector<Multi>& parameters, const InitialState<double>& near, bool check,
             LinearModel& out) const;

 private:
  // Searches rows that have no derivative at the point. Returns an outcome that names an equation among them, and marks
  // outputs in `rough` by the place where they have none.
  Outcome look_for_kinks(const LinearPoint& point, const std::vector<Multi>& parameters,
                         std::vector<std::string>& rough) const;

  const StateChoice& choice_;
  VariedEquations equations_;
  std::vector<Column> mass_;  // the mass matrix
};

}  // namespace anholon
