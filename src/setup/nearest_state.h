// The consistent state that is nearest in the mass norm to one that is not: positions first, then velocities (theory:
// events). Of velocities that is what an ideal impulse of the constraints makes.
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
  // `parameters`: where the structure of the equations is looked at.
  NearestState(const Scenario& s, const std::vector<W>& parameters);
  NearestState(const NearestState&) = delete;
  NearestState& operator=(const NearestState&) = delete;

  // Puts the nearest state in place of the state of a program, whatever its form. `leading`: the derivatives that this solves
  // for, near the state. The state stays as it is if it has other entries than that of Routh's equations, as it may have with
  // constraints of order 2 and more.
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
