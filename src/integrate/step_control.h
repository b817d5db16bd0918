// Order and length of Taylor steps from the coefficients of the series (Jorba & Zou 2005; theory: taylor). All
// functions are pure.
#pragma once
#include <algorithm>
#include <cmath>
#include <concepts>
#include <functional>
#include <span>
#include <vector>

#include "numeric/number.h"

namespace anholon {

struct StepSettings {
  double log_tolerance = -27.6310211159;  // natural logarithm, because 1e-400 is a tolerance too
  int order = 0;                          // of the Taylor polynomials; 0: chosen by the tolerance
  std::size_t most_steps = 50'000'000;
  std::function<bool()> cancelled;  // called between steps
  bool kernel = true;               // use a kernel if there is one
  bool measure = true;              // measure how regular J is, also if the kernel does not ask for it
  std::size_t integrals =
      0;  // so many of the first quadratures are integrated to the tolerance; the others as the motion's steps have it
  std::size_t known_from = 0,
              known_to = 0;     // the series of these quadratures are known to the tolerance over each step
  std::size_t followed_to = 0;  // so are those from there on, unless steps would be much shorter than the motion's
  bool other_rounding = false;  // of a kernel's coefficients (Rounding::other)
  bool coarse_times = false;    // of events: multiples of two round-offs, for a run whose roundings are to differ
  bool ordinary_steps = true;   // are not looked at closely
  bool multipliers = false;     // their series are asked for (Stepper::dense): by kernels in the motion's unknowns
  std::vector<std::size_t> from_zero =
      {};  // of what is watched for changes of sign: zero at the start, but for round-off
};

// The number of the first quadratures whose values steps have to heed.
inline std::size_t known_quadratures(const StepSettings& s) {
  return std::max({s.integrals, s.known_to, s.followed_to});
}

// ceil(-ln(tolerance)/2 + 1), and at least 4: the order of least work for the tolerance if work grows with the square
// of the order (Jorba & Zou 2005).
int least_work_order(double log_tolerance);
// Four more than least_work_order(), because work grows more slowly here (measured, bench/RESULTS.md). Not if the
// tolerance asks for the last digits, which longer steps would lose to round-off.
int taylor_order(double log_tolerance);
// True for tolerances below 1e-14.
bool asks_for_last_digits(double log_tolerance);
// A step is e^-shrink of the radius of convergence rho. With it, (h / rho)^order is what e^-2 per order makes for the
// order of Jorba & Zou, a whole number: tolerance / e^2 or less.
double step_shrink(double log_tolerance, int order);

// The Taylor series of one unknown: coefficients c_0, c_1, …, and the order d of its leading derivative.
template <Number N>
struct UnknownSeries {
  const N* c;
  int d;
};

// h = (rho / e^shrink) exp(-0.7/(p-1)), where rho is the smaller root of |x| / |x_k| for the last two orders k, in the
// greatest norm, relative to the size of x but at least 1 (Jorba & Zou 2005). Positions, velocities, … are measured
// each against their own size: an angle that has turned a thousand times must not loosen the tolerance of the
// velocities. So are unknowns of different dimensions (`scales`, Program::scales): an orbit in metres must not loosen
// the tolerance of angles. REQUIRES: the coefficients of x_j up to order - 1 + d_j.
template <Number N>
N step_size(std::span<const UnknownSeries<N>> x, std::span<const std::vector<std::uint32_t>> scales, int order,
            double shrink);

// A tolerance by its natural logarithm. Its value is 0 if it is too small for a double.
struct Tolerance {
  Tolerance(double log_tolerance) : logarithm(log_tolerance), value(std::exp(log_tolerance)) {}
  double logarithm, value;
};

// Returns `horizon`, or less: the last two terms of the integral over the step stay below the tolerance, relative to
// the greatest of the first three terms, the integral so far and 1. Errors of an integral along the motion do not
// affect later steps, but the integral has to be as accurate as the motion. A power is a product, whose series
// converges much more slowly where the motion is smooth everywhere (an oscillator). `coefficient`: of the quadrature,
// orders 0..order-1.
template <Number N, std::invocable<int> Coefficient>
N limited_by_quadrature(const N& horizon, int order, const Tolerance& tolerance, double integral,
                        const Coefficient& coefficient) {
  const double h = to_double(horizon);
  const auto size = [&](int k) { return std::abs(to_double(coefficient(k))); };
  double power = 1, square = h;
  for (int p = order - 1; p > 0; p >>= 1, square *= square)
    if (p & 1) power *= square;
  const double whole = std::max(1.0, std::abs(integral)),
               tail = power * std::max(size(order - 1) * h / order, size(order - 2) / (order - 1));
  const double first = h * std::max({size(0), size(1) * h / 2, size(2) * h * h / 3});
  if (tail <= tolerance.value * std::max(whole, first)) return horizon;
  // The terms are compared by logarithms, because they may leave the range of double.
  constexpr double kNothing = -1e300;
  double log_h = to_double(N(log(horizon)));
  const auto term = [&](int k) {
    const N c = abs(coefficient(k));
    return c > N(0) ? to_double(N(log(c))) + (k + 1) * log_h - std::log(k + 1) : kNothing;
  };
  // The first three terms grow with the horizon, too, so a horizon far beyond the series is shortened again.
  N limited = horizon;
  for (;;) {
    const double excess = std::max(term(order - 1), term(order - 2)) - tolerance.logarithm -
                          std::max({std::log(whole), term(0), term(1), term(2)});
    if (!(excess > 0)) return limited;
    limited = limited * N(std::exp(-excess / order));
    if (!(excess > order)) return limited;
    log_h -= excess / order;
  }
}

// Returns `horizon`, or less: over it the value of a quadrature, the integral of its rate, is known to the tolerance.
template <Number N, std::invocable<int> Coefficient>
N limited_by_value(const N& horizon, int order, const Tolerance& tolerance, const Coefficient& coefficient) {
  return limited_by_quadrature(horizon, order - 1, tolerance, to_double(coefficient(0)),
                               [&](int k) -> N { return coefficient(k + 1) * N(k + 1); });
}

}  // namespace anholon
