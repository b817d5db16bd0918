#include "integrate/regularity.h"

#include <algorithm>
#include <cmath>

namespace anholon {

// Applies a diagonal similarity by powers of 2 that brings rows and columns to like sizes (Osborne 1960), because the
// norm of a matrix in badly scaled unknowns tells nothing about its spectral radius.
template <Number N>
static void balance(Matrix<N>& a) {
  constexpr int kSweeps = 4;
  const std::size_t n = a.rows;
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (std::size_t i = 0; i < n; ++i) {
      double row = 0, column = 0;
      for (std::size_t j = 0; j < n; ++j)
        if (j != i) row += std::abs(to_double(a(i, j))), column += std::abs(to_double(a(j, i)));
      if (!(row > 0) || !(column > 0) || !std::isfinite(row) || !std::isfinite(column)) continue;
      const N factor(std::exp2(std::round(0.5 * std::log2(row / column))));
      for (std::size_t j = 0; j < n; ++j) a(j, i) = a(j, i) * factor;
      for (std::size_t j = 0; j < n; ++j) a(i, j) = a(i, j) / factor;
    }
}

template <Number N>
bool near(const Expansion<N>& p0, const Expansion<N>& p1) {
  constexpr double kNear = 0.5;
  const std::size_t n = p0.program().unknowns();
  const Matrix<N> j0 = p0.system_jacobian().matrix(), j1 = p1.system_jacobian().matrix();
  Matrix<N> a(n, n);
  std::vector<N> column(n), y;
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = 0; i < n; ++i) column[i] = j1(i, j) - j0(i, j);
    p0.system_jacobian().solve_once(column, y);
    for (std::size_t i = 0; i < n; ++i) a(i, j) = y[i];
  }
  balance(a);
  for (int doubling = 0; doubling < 3; ++doubling) {
    Matrix<N> square(n, n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < n; ++k)
        for (std::size_t j = 0; j < n; ++j) addmul(square(i, j), a(i, k), a(k, j));
    a = std::move(square);
  }
  double norm2 = 0;
  for (const N& v : a.data) norm2 += to_double(v) * to_double(v);
  return norm2 <= std::pow(kNear, 16);  // false if the norm is not a number
}

template <Number N>
Mode<N> weakest_mode(const Expansion<N>& at, const N& sigma) {
  const SystemJacobian<N>& J = at.system_jacobian();
  const std::size_t size = at.program().unknowns(), n = at.program().system->coordinates;
  Mode<N> m;
  m.sigma = sigma;
  m.v = at.weakest_direction();
  J.multiply(m.v, m.image);
  for (std::size_t i = 0; i < size; ++i)
    if (const N largest = J.largest(i); largest > N(0)) m.image[i] = m.image[i] / largest;
  std::vector<N> multipliers = m.v;
  std::fill(multipliers.begin(), multipliers.begin() + static_cast<std::ptrdiff_t>(n), N(0));
  J.multiply(multipliers, m.reaction);
  m.reaction.resize(n);
  return m;
}

// The cosine of the angle between two vectors, from element `from` on.
template <Number N>
static double cosine(const std::vector<N>& a, const std::vector<N>& b, std::size_t from = 0) {
  double dot = 0, aa = 0, bb = 0;
  for (std::size_t i = from; i < a.size(); ++i) {
    const double x = to_double(a[i]), y = to_double(b[i]);
    dot += x * y, aa += x * x, bb += y * y;
  }
  return aa > 0 && bb > 0 ? dot / std::sqrt(aa * bb) : 0;
}

template <Number N>
bool crossed(const Mode<N>& a, const Mode<N>& b, std::size_t coordinates) {
  constexpr double kSameDirection = 0.5;
  const auto flipped = [](double x, double y) {
    return std::abs(x) > kSameDirection && std::abs(y) > kSameDirection && x * y < 0;
  };
  return flipped(cosine(a.v, b.v), cosine(a.image, b.image)) ||
         flipped(cosine(a.v, b.v, coordinates), cosine(a.reaction, b.reaction));
}

namespace {

// A singular value of J may fall to this many round-offs of its value at the start; below, a solution has fewer than
// six digits.
constexpr double kNoDigits = 1e6;

template <Number N>
std::optional<Mode<N>> mode_of(Expansion<N>* there) {
  if (!there) return std::nullopt;
  const N sigma = there->smallest_singular_value();
  return weakest_mode(*there, sigma);
}

// True if the weakest direction at one point is mapped to the opposite at another. If several singular values pass zero
// together, the weakest direction there may belong to any of them.
template <Number N>
bool reversed(const Mode<N>& from, const Expansion<N>& there) {
  constexpr double kOpposite = -0.5;
  const SystemJacobian<N>& J = there.system_jacobian();
  double dot = 0, before = 0, after = 0;
  std::vector<N> image;
  J.multiply(from.v, image);
  for (std::size_t i = 0; i < image.size(); ++i) {
    const N largest = J.largest(i);
    const double a = to_double(from.image[i]), b = largest > N(0) ? to_double(N(image[i] / largest)) : 0;
    dot += a * b, before += a * a, after += b * b;
  }
  return dot < kOpposite * std::sqrt(before * after);
}

}  // namespace

template <Number N>
Outcome JacobianGuard<N>::check(Expansion<N>& at, const W& t, StepRecord<N>& record) {
  sigma_ = at.smallest_singular_value();
  const std::vector<N>& v = at.weakest_direction();
  if (record.first_sigma == N(0)) record.first_sigma = sigma_;
  record.least_regular.see(sigma_, t, v);
  // Steps shrink towards a point where constraints lose their hold, and would come out on the other side with one
  // motion of several. Where coordinates are singular (Euler's angles) the motion beyond is the only one.
  const auto larger = [](const N& a, const N& b) { return abs(a) < abs(b); };
  const bool of_constraints =
      std::max_element(v.begin(), v.end(), larger) - v.begin() >= static_cast<std::ptrdiff_t>(coordinates_);
  if (of_constraints && sigma_ < record.first_sigma * unit_roundoff<N>() * N(kNoDigits)) return becomes_singular();
  return {};
}

// Steps end where J may become singular, and shrink towards a singular point.
template <Number N>
typename JacobianGuard<N>::W JacobianGuard<N>::on_the_branch(PresentStep<N>& step, W h, StepRecord<N>& record) const {
  // The range is from a horizon of e^300 (a polynomial motion) to far below any step.
  constexpr int kMostHalvings = 600;
  if (record.branch_step > W(0) && abs(h) > record.branch_step * W(4))
    h = h > W(0) ? record.branch_step * W(4) : record.branch_step * W(-4);
  const auto on_it = [&](const W& part) {
    const Expansion<N>* there = step.prepare(part);
    return there && near(step.series(), *there);
  };
  for (int k = 0; k < kMostHalvings && !(on_it(h) && on_it(h * W(0.5))); ++k) h = h * W(0.5);
  record.branch_step = abs(h);
  return h;
}

namespace {

// Looks within a step for a point at which J is singular.
template <Number N>
class SingularPoint {
 public:
  using W = Wider<N>;
  // `start`: sigma where the step begins.
  SingularPoint(PresentStep<N>& step, std::size_t coordinates, N start)
      : step_(step), coordinates_(coordinates), start_(start) {}

  // Looks between two distances, of which the first has the mode `low`. If the weakest direction is nearly the same at
  // both ends, the ends are trusted; other parts are halved, at most `halvings` times, and at least `sure` times.
  std::optional<W> within(const W& from, const Mode<N>& low, const W& to, int sure, int halvings) const {
    constexpr double kAlike = 0.8;
    Expansion<N>* end = step_.prepare(to);
    const std::optional<Mode<N>> high = mode_of(end);
    if (!high) return std::nullopt;
    if (passed(low, *end, *high)) {
      if (const std::optional<W> met = located(from, low, to)) return met;
    } else if (sure <= 0 && std::abs(cosine(low.v, high->v)) > kAlike) {
      return std::nullopt;
    }
    if (halvings == 0) return std::nullopt;
    const W middle = from + (to - from) * W(0.5);
    const std::optional<Mode<N>> there = mode_of(step_.prepare(middle));
    if (!there) return std::nullopt;
    if (const std::optional<W> met = within(from, low, middle, sure - 1, halvings - 1)) return met;
    return within(middle, *there, to, sure - 1, halvings - 1);
  }

 private:
  bool passed(const Mode<N>& from, const Expansion<N>& there, const Mode<N>& m) const {
    return crossed(from, m, coordinates_) || reversed(from, there);
  }

  // Locates the point by bisection; returns nullopt if the singular value does not vanish there.
  std::optional<W> located(W from, Mode<N> low, W to) const {
    constexpr double kVanished = 1e-6;
    constexpr int kBisections = 60, kRoundoffs = 4096;
    for (int k = 0; k < kBisections; ++k) {
      const W middle = from + (to - from) * W(0.5);
      if (middle == from || middle == to) break;
      Expansion<N>* there = step_.prepare(middle);
      std::optional<Mode<N>> m = mode_of(there);
      if (!m) return middle;
      if (passed(low, *there, *m))
        to = middle;
      else
        from = middle, low = std::move(*m);
    }
    // If a step begins beside the singular point, the value found there is round-off, not a small part of `start_`.
    const N roundoff = unit_roundoff<N>() * N(kRoundoffs);
    return low.sigma < start_ * N(kVanished) || low.sigma < roundoff ? std::optional<W>(from) : std::nullopt;
  }

  PresentStep<N>& step_;
  std::size_t coordinates_;
  N start_;
};

}  // namespace

template <Number N>
std::optional<typename JacobianGuard<N>::W> JacobianGuard<N>::singular_within(PresentStep<N>& step, const W& h,
                                                                              const W& last_step) const {
  constexpr double kFaster = 0.6;
  // The halvings of a step in which the weakest direction turns, the halvings of a long step in any case, and the
  // number of unknowns for which halvings cost little.
  constexpr int kHalvings = 5, kSure = 3;
  constexpr std::size_t kFewUnknowns = 64;
  const bool by_kernel = step.expander.kernel() != nullptr, is_long = longer_than(h, last_step);
  // A singular value that vanishes within the step has fallen by more than half in a step of the same length before.
  // Its earlier value is not known after steps by the kernel.
  const bool suspected =
      by_kernel || step.expander.suspected() || is_long || sigma_ < step.track.now.record.sigma_before * N(kFaster);
  if (!suspected) return std::nullopt;
  const std::optional<Mode<N>> here =
      by_kernel ? mode_of(step.look.prepare(step.t(), step.track.now.state, {})) : weakest_mode(step.series(), sigma_);
  if (!here) return std::nullopt;
  // Without multipliers only coordinates can be singular.
  const std::size_t unknowns = step.series().program().unknowns();
  const bool few = unknowns > coordinates_ && unknowns <= kFewUnknowns;
  return SingularPoint<N>(step, coordinates_, here->sigma)
      .within(W(0), *here, h, few && is_long ? kSure : 0, few ? kHalvings : 0);
}

template <Number N>
bool JacobianGuard<N>::regular_between(LookAhead<N>& look, const MotionState<N>& before,
                                       const MotionState<N>& after) const {
  const std::optional<Mode<N>> from = mode_of(look.prepare(before.t, before.state, {})),
                               to = mode_of(look.prepare(after.t, after.state, {}));
  return from && to && !crossed(*from, *to, coordinates_);
}

#define INSTANTIATE(N)                                                                                                 \
  template bool near(const Expansion<N>&, const Expansion<N>&);                                                        \
  template Mode<N> weakest_mode(const Expansion<N>&, const N&);                                                        \
  template bool crossed(const Mode<N>&, const Mode<N>&, std::size_t);                                                  \
  template class JacobianGuard<N>;
INSTANTIATE(double)
INSTANTIATE(long double)
INSTANTIATE(Quad)
INSTANTIATE(Multi)
#undef INSTANTIATE

}  // namespace anholon
