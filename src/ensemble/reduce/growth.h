// The growth of a formula towards a place, which tells a formula without a bound from one with a sharp peak.
//
// At distances s from the place that fall by a constant factor, the greatest value of a formula without a bound rises by
// increments that do not fall: they are multiples of s^-p at a singularity of order p, and equal for a logarithm. The
// increments of a formula with a bound fall as soon as s is less than the width of the peak, also at a cusp such as
// -s^(1/10). A peak that is too narrow for the distances counts as one without a bound.
#pragma once
#include <functional>

namespace anholon {

struct Growth {
  double extreme = 0;                       // the value of f at the place
  bool no_upper = false, no_lower = false;  // the values have no such bound
  // The integral of the formula converges at the place, and is known up to `rest`.
  bool integrable = true;
  double rest = 0;
};

// Returns the growth of f, on [0, h], on both sides of the place where sign * f is greatest within `reach` of x. h may
// be negative. `noise`: the round-off of the values away from the place.
Growth growth_at(const std::function<double(double)>& f, double sign, double h, double x, double reach, double noise);

// Returns the value of f at x in [0, h]. At the end of a step it is the greatest value shortly before, because a step
// ends a little beyond a kink, at which f may have its extreme.
double greatest_near(const std::function<double(double)>& f, double h, double x);

}  // namespace anholon
