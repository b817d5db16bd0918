// Finds the points within a step where a function may do something that its Taylor series do not show: a pulse, a ramp,
// a wall that lies wholly within the step. The series of its argument are good. The function is evaluated at the
// extrema and zeros of its argument and at the ends of parts of the step; where it differs from its own series, the
// equations are to be looked at.
#pragma once
#include "kernel/plan/plan.h"
#include "numeric/number.h"

namespace anholon {

// The value of the argument of such a function at a moment.
struct HidingArgument {
  Hiding function;
  double value;
};

// Adds the points, in (0, h). `argument` and `value`: the Taylor coefficients of orders 0..degree of the argument and
// of the function. For a quotient the points are where the argument is nearly zero. Returns false if the series of the
// argument do not show over the whole step that the function hides nothing more.
template <Number N>
bool add_hidden_points(const Hiding& function, const N* argument, const N* value, int degree, const N& h,
                       std::vector<N>& points);

// True if the argument changes by too little over the step for any such point. Element k of the series is at offset k *
// stride.
template <Number N>
bool hides_nothing(const Hiding& function, const N* argument, std::size_t stride, int degree, const N& h);

extern template bool add_hidden_points(const Hiding&, const double*, const double*, int, const double&,
                                       std::vector<double>&);
extern template bool add_hidden_points(const Hiding&, const long double*, const long double*, int, const long double&,
                                       std::vector<long double>&);
extern template bool add_hidden_points(const Hiding&, const Quad*, const Quad*, int, const Quad&, std::vector<Quad>&);
extern template bool add_hidden_points(const Hiding&, const Multi*, const Multi*, int, const Multi&,
                                       std::vector<Multi>&);
extern template bool hides_nothing(const Hiding&, const double*, std::size_t, int, const double&);

}  // namespace anholon
