#include "integrate/step_control.h"

namespace anholon {

int least_work_order(double log_tolerance) { return std::max(4, static_cast<int>(std::ceil(-log_tolerance / 2 + 1))); }

int taylor_order(double log_tolerance) {
  constexpr int kMore = 4;
  return least_work_order(log_tolerance) + (asks_for_last_digits(log_tolerance) ? 0 : kMore);
}

bool asks_for_last_digits(double log_tolerance) {
  constexpr double kLog = -32.3;  // of a tolerance slightly below 1e-14
  return log_tolerance <= kLog;
}

double step_shrink(double log_tolerance, int order) { return 2.0 * least_work_order(log_tolerance) / order; }

namespace {

constexpr double kNothing = -1e300;  // the logarithm of zero

// Returns k! c_k; the product of 1, 2, …, k is computed first.
template <Number N>
N derivative(const UnknownSeries<N>& x, int k) {
  N factorial(1);
  for (int i = 1; i <= k; ++i) factorial = factorial * N(i);
  return x.c[k] * factorial;
}

// The logarithm of the coefficient of this order of x^(k), because coefficients of high order may leave the range of
// double.
template <Number N>
double log_coefficient(const UnknownSeries<N>& x, int k, int order) {
  double factor = 1;
  for (int i = 1; i <= k; ++i) factor *= order + i;
  const N v = abs(x.c[order + k]);
  return v > N(0) ? to_double(N(log(v))) + std::log(factor) : kNothing;
}

// Errors of multipliers that are no states do not affect later steps, but a step must not pass a pole of a multiplier,
// where a constraint loses its hold: the step stays within half of the multipliers' radius of convergence. Returns the
// logarithm of the greatest of their last coefficients, relative to their values.
template <Number N>
double log_pole(std::span<const UnknownSeries<N>> x, int order) {
  double pole = kNothing;
  for (const UnknownSeries<N>& u : x) {
    if (u.d > 0) continue;
    const N top = abs(u.c[order - 1]), value = abs(u.c[0]);
    if (!(top > N(0)) || !(value > N(0))) continue;
    pole = std::max(pole, to_double(N(log(top))) - std::max(0.0, to_double(N(log(value)))));
  }
  return pole;
}

}  // namespace

template <Number N>
N step_size(std::span<const UnknownSeries<N>> x, std::span<const std::vector<std::uint32_t>> scales, int order,
            double shrink) {
  double last_weight = kNothing, before_weight = kNothing;
  int levels = 0;
  for (const UnknownSeries<N>& u : x) levels = std::max(levels, u.d);
  for (const std::vector<std::uint32_t>& scale : scales)
    for (int k = 0; k < levels; ++k) {
      double size = 1, last = kNothing, before_last = kNothing;
      for (const std::uint32_t j : scale) {
        const UnknownSeries<N>& u = x[j];
        if (k >= u.d) continue;
        size = std::max(size, std::abs(to_double(derivative(u, k))));
        last = std::max(last, log_coefficient(u, k, order));
        before_last = std::max(before_last, log_coefficient(u, k, order - 1));
      }
      last_weight = std::max(last_weight, last - std::log(size));
      before_weight = std::max(before_weight, before_last - std::log(size));
    }
  constexpr double kFar = 300;
  const double log_rho = std::min({kFar, -last_weight / order, -before_weight / (order - 1)}),
               log_reach = std::min(kFar, -log_pole(x, order) / (order - 1));
  return N(std::exp(std::min(log_rho - shrink - 0.7 / (order - 1), log_reach - 0.7)));
}

template double step_size(std::span<const UnknownSeries<double>>, std::span<const std::vector<std::uint32_t>>, int,
                          double);
template long double step_size(std::span<const UnknownSeries<long double>>, std::span<const std::vector<std::uint32_t>>,
                               int, double);
template Quad step_size(std::span<const UnknownSeries<Quad>>, std::span<const std::vector<std::uint32_t>>, int, double);
template Multi step_size(std::span<const UnknownSeries<Multi>>, std::span<const std::vector<std::uint32_t>>, int,
                         double);

}  // namespace anholon
