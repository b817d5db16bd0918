// Linear models of a scenario at its initial state.
#pragma once
#include "linear/varied_equations.h"

namespace anholon {

class LinearPoint;

// The precision of the thread must be that of its construction.
class Linearizer {
 public:
  Linearizer(Workspace& scenario, const StateChoice& choice, Signals signals = {});
  // With other values of the parameters; the initial data are solved anew, from `near`, their solution in double. Only if
  // `check` it is found out whether the motion is steady.
  Outcome at(const std::vector<Multi>& parameters, const InitialState<double>& near, bool check,
             LinearModel& out) const;

 private:
  // Looks for rows that have no derivative at the point. Returns an outcome that names an equation among them, and marks
  // outputs in `rough` by the place where they have none.
  Outcome look_for_kinks(const LinearPoint& point, const std::vector<Multi>& parameters,
                         std::vector<std::string>& rough) const;

  const StateChoice& choice_;
  VariedEquations equations_;
  std::vector<Column> mass_;  // the mass matrix
};

}  // namespace anholon
