// The exact derivatives of the rates x' = f(t, x) of a motion by its state and its parameters.
//
// Differentiated as often as the structure says, the equations are E_i(t, x, a, p) = 0 in the state x, what leads it (a:
// accelerations, multipliers, rates) and the parameters p. So  dE/da da = -dE/dx dx - dE/dp dp.  The partial derivatives are
// formulas, evaluated in doubles at a point whose a is known.  (theory: dae-view)
#pragma once
#include "setup/scenario.h"

namespace anholon {

class StateJacobian {
 public:
  explicit StateJacobian(Workspace& scenario);

  // a_j by the state entries (unknown j, derivative k < d_j, one after the other) and by the parameters of the model:
  // row j of both, row after row. NaN where dE/da is singular.
  struct Derivatives {
    std::size_t states, parameters;
    std::vector<double> by_state, by_parameter;
  };
  // `state`: x_j^(k), k < d_j, one after the other; `leading`: a_j.
  Derivatives at(double t, const std::vector<double>& state, const std::vector<double>& leading,
                 const std::vector<double>& parameters) const;

 private:
  // What the inputs of the tape are.
  struct Place {
    enum class Kind : std::uint8_t { time, state, leading, none } kind;
    std::size_t index;
  };
  std::size_t unknowns_, states_, parameters_;
  Tape tape_;
  std::vector<Place> inputs_;
  struct Partial {
    std::size_t row, column;  // columns: state, leading, parameters
  };
  std::vector<Partial> partials_;
};

}  // namespace anholon
