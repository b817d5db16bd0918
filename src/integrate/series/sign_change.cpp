#include "integrate/series/sign_change.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace anholon {

namespace {

// At this depth, parts of [0, h] are narrower than a round-off of h in double.
constexpr int kDeepest = 56, kBisections = 200, kPolish = 4;

// Returns where in [from, to], a part of [0, 1], the polynomial with the Bernstein coefficients b on this part is first
// below -floor.
template <Number N>
std::optional<N> search(std::vector<N> b, const N& from, const N& to, const N& floor, int depth) {
  if (b.front() < -floor) return from;
  if (std::none_of(b.begin(), b.end(), [&](const N& x) { return x < -floor; })) return std::nullopt;
  if (depth == 0) return b.back() < -floor ? std::optional<N>(to) : std::nullopt;
  std::vector<N> left = b;
  for (std::size_t k = 1; k < b.size(); ++k) {
    for (std::size_t j = 0; j + k < b.size(); ++j) b[j] = (b[j] + b[j + 1]) / N(2);
    left[k] = b[0];
  }
  // Now b holds the right half.
  const N middle = (from + to) / N(2);
  if (auto x = search(std::move(left), from, middle, floor, depth - 1)) return x;
  return search(std::move(b), middle, to, floor, depth - 1);
}

}  // namespace

template <Number N>
std::optional<N> first_below(const N* c, int degree, const N& h, const N& floor) {
  while (degree > 0 && c[degree] == N(0)) --degree;
  std::vector<N> a;
  N power(1), rest(0);
  for (int k = 0; k <= degree; ++k) {
    a.push_back(c[k] * power);
    if (k > 0) rest += abs(a.back());
    power = power * h;
    if (!is_finite(a.back())) return std::nullopt;
  }
  if (!(a[0] - rest < -floor)) return std::nullopt;
  const auto found = search(bernstein(std::move(a)), N(0), N(1), floor, kDeepest);
  if (!found) return std::nullopt;
  if (c[0] < -floor) return N(0);
  // Bisection finds where the polynomial passes -floor; Newton's steps go back from there to zero, which is near.
  N low(0), high = *found * h;
  for (int k = 0; k < kBisections; ++k) {
    const N middle = (low + high) / N(2);
    if (middle == low || middle == high) break;
    (value_at(c, degree, middle) < -floor ? high : low) = middle;
  }
  N x = high, value = abs(value_at(c, degree, x));
  for (int k = 0; k < kPolish && value > N(0); ++k) {
    N slope(0);
    for (int j = degree; j >= 1; --j) slope = slope * x + c[j] * N(j);
    if (!(abs(slope) > N(0))) break;
    const N next = x - value_at(c, degree, x) / slope;
    const N there = abs(value_at(c, degree, next));
    if (!(there < value) || (next > N(0)) != (h > N(0)) || abs(next) > abs(h)) break;
    x = next;
    value = there;
  }
  return x;
}

// The condition is log|c_k| + k L <= log_tolerance + log|c_j| + j L for one j; the bound of L grows with the best j.
template <Number N>
double log_reach(const N* c, int degree, const N& floor, double log_tolerance) {
  constexpr double kFar = 300;
  const auto size = [](const N& x) { return to_double(N(log(x))); };
  double reach = kFar;
  for (int k = std::max(1, degree - 1); k <= degree; ++k) {
    const N last = abs(c[k]);
    if (!(last > N(0)) || !is_finite(last)) continue;
    double best = -kFar;
    bool bounded = false;
    for (int j = 0; j < degree - 1; ++j) {
      const N before = j == 0 && abs(c[0]) < floor ? floor : N(abs(c[j]));
      if (!(before > N(0)) || !is_finite(before)) continue;
      best = std::max(best, (log_tolerance + size(before) - size(last)) / (k - j));
      bounded = true;
    }
    if (bounded) reach = std::min(reach, best);
  }
  return reach;
}

template std::optional<double> first_below(const double*, int, const double&, const double&);
template std::optional<long double> first_below(const long double*, int, const long double&, const long double&);
template std::optional<Quad> first_below(const Quad*, int, const Quad&, const Quad&);
template std::optional<Multi> first_below(const Multi*, int, const Multi&, const Multi&);
template double log_reach(const double*, int, const double&, double);
template double log_reach(const long double*, int, const long double&, double);
template double log_reach(const Quad*, int, const Quad&, double);
template double log_reach(const Multi*, int, const Multi&, double);

}  // namespace anholon
