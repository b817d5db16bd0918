// Linear models of a scenario at its initial state.
#pragma once
#include "linear/linear_point.h"

namespace anholon {

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
  // outputs in `rough` by what is there.
  Outcome look_for_kinks(const LinearPoint& point, const std::vector<Multi>& parameters,
                         std::vector<std::string>& rough) const;
  // Returns the outcome that names the formula for which the equations have no derivative at the point.
  Outcome without_derivative(const LinearPoint& point) const;
  void look_for_lacking_outputs(const LinearPoint& point, std::vector<std::string>& rough) const;
  // "no derivative by x'", and "1/sqrt(x'^2) in the force 'drag' has no value, where x'^2 = 0".
  std::string lacking(const LinearPoint::Fault& fault) const;
  std::string formula_of(const LinearPoint& point, const LinearPoint::Fault& fault) const;

  const StateChoice& choice_;
  VariedEquations equations_;
  std::vector<Column> mass_;  // the mass matrix
};

}  // namespace anholon
