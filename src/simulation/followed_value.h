// The value of a formula at a time within the last step, by the equations there.
#pragma once
#include <limits>
#include <utility>

#include "integrate/stepper.h"

namespace anholon {

// NaN where the quadrature of the program has no value; and the magnitude of all that the value is made of. The point is
// an expansion of the caller.
template <Number N>
std::pair<double, double> value_of_quadrature(const Stepper<N>& stepper, const Wider<N>& t, std::size_t quadrature,
                                              Expansion<Wider<N>>& point) {
  if (!stepper.at(t, point).ok()) return {std::numeric_limits<double>::quiet_NaN(), 0};
  point.evaluate_quadratures();
  std::vector<Wider<N>> sizes;
  point.machine().made_of(sizes);
  const Program& program = point.program();
  return {to_double(point.quadrature(quadrature)[0]),
          to_double(sizes[program.tape.roots[program.unknowns() + quadrature]])};
}

}  // namespace anholon
