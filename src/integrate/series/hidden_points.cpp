#include "integrate/series/hidden_points.h"

#include <algorithm>
#include <cmath>

#include "integrate/series/sign_change.h"
#include "tape/function_value.h"

namespace anholon {

namespace {

// A step is divided into kParts parts; extrema and zeros are found by kHalvings halvings.
constexpr int kParts = 8, kHalvings = 40;
// Relative to the greater of the function's value and 1: a function that differs from its series by more may hide a
// ramp. The equations decide about the step.
constexpr double kDiffers = 1e-3;
// Values below kNoise round-offs of the terms they are made of are zero; the stretch where they are is sampled at
// kAcross points.
constexpr int kNoise = 64, kAcross = 16;

template <Number N>
N value_of(const Hiding& f, const N& u) {
  if (f.function) return function_value(*f.function, u);
  const N size = exp(N(f.exponent) * log(abs(u)));
  return u < N(0) && std::fmod(f.exponent, 2) != 0 ? N(-size) : size;
}

// Returns where a slope changes its sign between two points. up: it is positive at `low`.
template <Number N, class Slope>
N turn(Slope slope, N low, N high, bool up) {
  for (int k = 0; k < kHalvings; ++k) {
    const N middle = (low + high) / N(2);
    ((slope(middle) > N(0)) == up ? low : high) = middle;
  }
  return high;
}

// Returns the largest value of u between two points, or the least unless `up`.
template <Number N, class Value>
N extremum(Value u, N low, N high, bool up) {
  for (int k = 0; k < kHalvings; ++k) {
    const N third = (high - low) / N(3), a = low + third, b = high - third;
    if ((u(a) > u(b)) == up)
      high = b;
    else
      low = a;
  }
  return (low + high) / N(2);
}

// True if the last terms of a series at h are small against `size`, or if there are none to judge by.
template <Number N>
bool reaches(const N* c, int degree, const N& h, const N& size) {
  constexpr double kSmall = 0.01;
  if (degree < 2) return true;
  N power(1);
  for (int k = 1; k < degree; ++k) power *= h;
  const N tail = (abs(c[degree - 1]) + abs(c[degree]) * h) * power;
  return !is_finite(tail) || tail <= size * N(kSmall);
}

}  // namespace

// Bounds the change by a sum of absolute terms, as four partial sums that do not depend on each other.
template <Number N>
bool hides_nothing(const Hiding& function, const N* argument, std::size_t stride, int degree, const N& h) {
  const N length = abs(h), square = length * length, fourth = square * square;
  const auto size = [&](int k) { return k > degree ? N(0) : N(abs(argument[static_cast<std::size_t>(k) * stride])); };
  int k = degree / 4 * 4;
  N a = k > 0 ? size(k) : N(0), b = size(k + 1), c = size(k + 2), d = size(k + 3);
  const N* at = argument + static_cast<std::size_t>(k) * stride;
  for (; k > 0; k -= 4) {
    at -= 4 * stride;
    a = a * fourth + (k > 4 ? N(abs(at[0])) : N(0));
    b = b * fourth + abs(at[stride]);
    c = c * fourth + abs(at[2 * stride]);
    d = d * fourth + abs(at[3 * stride]);
  }
  const N moves = a + b * length + (c + d * length) * square;
  const N most(function.hides_beyond());
  return moves < (function.function ? most : N(most * abs(argument[0])));
}

template <Number N>
bool add_hidden_points(const Hiding& function, const N* argument, const N* value, int degree, const N& h,
                       std::vector<N>& points) {
  if (hides_nothing(function, argument, 1, degree, h)) return true;
  const N length = abs(h);
  N moves(0);
  for (int k = degree; k >= 1; --k) moves = (moves + abs(argument[k])) * length;
  const bool quotient = function.quotient;
  const N near_zero(quotient ? function.near_zero : 0);
  const auto u = [&](const N& x) { return value_at(argument, degree, x); };
  // The slope along the step.
  const auto slope_of = [&](const N& x) {
    N slope(0);
    for (int k = degree; k >= 1; --k) slope = slope * x + argument[k] * N(k);
    return h > N(0) ? slope : N(-slope);
  };
  const auto ask = [&](const N& x) {
    if (quotient) {
      if (abs(u(x)) < abs(argument[0]) * near_zero) points.push_back(x);
      return;
    }
    const N is = value_of(function, u(x)), foretold = value_at(value, degree, x);
    const N size = abs(is) > N(1) ? abs(is) : N(1);
    if (!(abs(N(is - foretold)) <= size * N(kDiffers))) points.push_back(x);
  };
  // Asks at a point, and on both sides where the argument differs by 1: a pulse of both signs is zero at its centre.
  const auto ask_around = [&](const N& x, const N& from, const N& to) {
    ask(x);
    if (!function.function) return;
    const N centre = u(x);
    for (const N& end : {from, to}) {
      if (!(abs(N(u(end) - centre)) > N(1))) continue;
      N near = x, far = end;
      for (int k = 0; k < kHalvings; ++k) {
        const N middle = (near + far) / N(2);
        (abs(N(u(middle) - centre)) > N(1) ? far : near) = middle;
      }
      ask(far);
    }
  };
  const auto end_of = [&](int part) { return h * N(part) / N(kParts); };
  N last = argument[0], rise = slope_of(N(0)), least = abs(last), most = abs(last);
  for (int i = 1; i <= kParts; ++i) {
    const N here = u(end_of(i)), now = here - last;
    if ((last < N(0)) != (here < N(0))) {
      N low = end_of(i - 1), high = end_of(i);
      for (int k = 0; k < kHalvings; ++k) {
        const N middle = (low + high) / N(2);
        ((u(middle) < N(0)) == (last < N(0)) ? low : high) = middle;
      }
      ask_around(high, end_of(i - 1), end_of(i));
      if (quotient) {
        // A high power is round-off in a wide range around its zero, and the divisor vanishes somewhere in that range.
        const N noise = unit_roundoff<N>() * N(kNoise) * (moves + abs(argument[0]));
        N from = high, to = high;
        for (int k = 1; k <= kAcross && abs(u(from)) <= noise; ++k) from = high - h * N(k) / N(2 * kAcross);
        for (int k = 1; k <= kAcross && abs(u(to)) <= noise; ++k) to = high + h * N(k) / N(2 * kAcross);
        for (int k = 1; k < kAcross; ++k)
          if (const N x = from + (to - from) * N(k) / N(kAcross); abs(x) < length && (x > N(0)) == (h > N(0)))
            points.push_back(x);
      }
    }
    const N slope = slope_of(end_of(i));
    if (const bool up = rise > N(0); (slope > N(0)) != up || (now > N(0)) != up)
      ask_around((slope > N(0)) != up ? turn(slope_of, end_of(i - 1), end_of(i), up)
                                      : extremum(u, end_of(i - 1), end_of(i), up),
                 end_of(i - 1), end_of(i));
    rise = slope;
    last = here;
    least = std::min(least, N(abs(here)));
    most = std::max(most, N(abs(here)));
    if (i < kParts) ask(end_of(i));
  }
  return !function.needs_reach || reaches(argument, degree, length,
                                          !function.function ? most
                                          : least < N(1)     ? N(1)
                                                             : least);
}

template bool hides_nothing(const Hiding&, const double*, std::size_t, int, const double&);
template bool add_hidden_points(const Hiding&, const double*, const double*, int, const double&, std::vector<double>&);
template bool add_hidden_points(const Hiding&, const long double*, const long double*, int, const long double&,
                                std::vector<long double>&);
template bool add_hidden_points(const Hiding&, const Quad*, const Quad*, int, const Quad&, std::vector<Quad>&);
template bool add_hidden_points(const Hiding&, const Multi*, const Multi*, int, const Multi&, std::vector<Multi>&);

}  // namespace anholon
