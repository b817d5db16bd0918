// The consistent state that is nearest, in the mass norm, to an inconsistent one: positions first, then velocities
// (theory: events). The nearest velocities are those after an ideal impulse of the constraints.
//
// The mass matrix and the rows of the constraints are those of Routh's equations, whatever the form of the motion. Positions
// have to satisfy constraints of position only.
#pragma once
#include "program/expansion.h"
#include "setup/scenario.h"

namespace anholon {

template <Number W>
class NearestState {
 public:
  // `parameters`: the values at which the structure of the equations is determined.
  NearestState(const Scenario& s, const std::vector<W>& parameters);
  NearestState(const NearestState&) = delete;
  NearestState& operator=(const NearestState&) = delete;

  // Replaces the state of a program, whatever its form, by the nearest state. `leading`: the derivatives that the
  // program solves for, near the state. The state is unchanged if it has other entries than that of Routh's equations,
  // which may be the case with constraints of order 2 and more.
  Outcome put(const Program& of, const W& t, const std::vector<W>& parameters, const std::vector<W>& leading,
              std::vector<W>& state) const;

 private:
  System routh_;
  Program program_;  // holds a pointer to `routh_`
};

extern template class NearestState<long double>;
extern template class NearestState<Quad>;
extern template class NearestState<Multi>;

}  // namespace anholon
