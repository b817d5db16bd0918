#include "integrate/one_sided_start.h"

#include <algorithm>
#include <cmath>

#include "program/fault.h"

namespace anholon {

namespace {

// With this part, the neglected terms of a force like the square root of the time are as large as the tolerance.
constexpr double kPartOfTolerance = 2.0 / 3;
constexpr int kRoundoffsOfTime = 32;
constexpr int kMostIterations = 60;
// Iterations end when they change the leading derivatives by the part kSettled. Leading derivatives that change by more
// than the part kSame with the length of the step grow without bound at its start.
constexpr double kSettled = 1e-10, kSame = 0.05;
// A simple iteration goes on while it shrinks its changes to the part kContracts. Newton's differences are taken over
// the part kDifference of the derivatives.
constexpr double kContracts = 0.3, kDifference = 1e-4;

template <Number W>
W largest(const std::vector<W>& list) {
  W most(1);
  for (const W& x : list)
    if (abs(x) > most) most = abs(x);
  return most;
}

template <Number W>
double difference(const std::vector<W>& a, const std::vector<W>& b) {
  W most(0);
  for (std::size_t j = 0; j < a.size(); ++j)
    if (const W d = abs(W(a[j] - b[j])); d > most) most = d;
  return to_double(W(most / largest(a)));
}

template <Number W>
bool all_finite(const std::vector<W>& list) {
  return std::all_of(list.begin(), list.end(), [](const W& x) { return is_finite(x); });
}

// Returns a direction that no model prefers.
template <Number W>
std::vector<W> arbitrary(std::size_t size, double sign) {
  std::vector<W> list;
  for (std::size_t j = 0; j < size; ++j)
    list.push_back(W(sign * (1 + 0.6180339887498949 * static_cast<double>(j % 5))));
  return list;
}

}  // namespace

template <Number N>
OneSidedStart<N>::OneSidedStart(PresentStep<N>& step, Outcome fault) : fault_(std::move(fault)) {
  if (!first_fault(step.series().program(), step.series().machine(), 0))
    step.expander.point(step.track, false).leading(at_point_);
}

// Returns a part of the times in which the lower derivatives change by their size, at least 1, measured as in
// step_size().
template <Number N>
typename OneSidedStart<N>::W OneSidedStart<N>::length(const PresentStep<N>& step, const Expansion<W>& point,
                                                      double log_tolerance) {
  const Program& p = point.program();
  double time = 1;
  for (const std::vector<std::uint32_t>& scale : p.scales)
    for (int k = 0; k < *std::max_element(p.d.begin(), p.d.end()); ++k) {
      double size = 1;
      for (const std::uint32_t j : scale)
        if (k < p.d[j]) size = std::max(size, std::abs(to_double(point.derivative(j, k))));
      for (const std::uint32_t j : scale)
        for (int i = k + 1; i <= p.d[j]; ++i)
          if (const double rate = std::abs(to_double(point.derivative(j, i))); rate > 0 && std::isfinite(rate))
            time = std::min(time, std::pow(size / rate, 1.0 / (i - k)));
    }
  const W part = W(std::exp(log_tolerance * kPartOfTolerance)) * W(time),
          resolved = convert<W>(unit_roundoff<N>()) * W(kRoundoffsOfTime) * abs(step.t());
  return part > resolved ? part : resolved;
}

// Computes G: the leading derivatives that the equations have at h, on the polynomial that ends with the given ones.
// Returns nullopt if the equations have none there.
template <Number N>
std::optional<std::vector<typename OneSidedStart<N>::W>>
OneSidedStart<N>::leading_after(PresentStep<N>& step, const W& h, std::vector<W> leading) const {
  step.expander.cut_to(step.track.now, leading);
  Expansion<N>* there = step.prepare(h);
  if (!there || !there->solve().ok()) return std::nullopt;
  std::vector<N> narrow;
  there->leading(narrow);
  convert_all(narrow, leading);
  return all_finite(leading) ? std::optional(std::move(leading)) : std::nullopt;
}

// Finds a solution of a = G(a), by simple iteration as long as it contracts, by Newton's method with differences
// otherwise.
template <Number N>
std::optional<std::vector<typename OneSidedStart<N>::W>> OneSidedStart<N>::fixed_point(PresentStep<N>& step, const W& h,
                                                                                       std::vector<W> a) const {
  const std::size_t size = a.size();
  double before = 0;
  for (int k = 0; k < kMostIterations; ++k) {
    const auto image = leading_after(step, h, a);
    if (!image) return std::nullopt;
    const double change = difference(*image, a);
    if (change < kSettled) return image;
    if (k == 0 || change < kContracts * before) {
      a = *image;
      before = change;
      continue;
    }
    before = change;
    const W by = largest(a) * W(kDifference);
    Matrix<W> slope(size, size);  // of a - G(a)
    std::vector<W> r(size), y;
    for (std::size_t j = 0; j < size; ++j) {
      std::vector<W> moved = a;
      moved[j] += by;
      const auto there = leading_after(step, h, moved);
      if (!there) return std::nullopt;
      for (std::size_t i = 0; i < size; ++i) slope(i, j) = (i == j ? W(1) : W(0)) - ((*there)[i] - (*image)[i]) / by;
      r[j] = (*image)[j] - a[j];
    }
    Lu<W> lu;
    if (!lu.factor(slope)) return std::nullopt;
    lu.solve(r, y);
    for (std::size_t j = 0; j < size; ++j) a[j] += y[j];
    if (!all_finite(a)) return std::nullopt;
  }
  return std::nullopt;
}

// Returns the only solution; nullopt if there is none or more than one. If the equations have no value at the point
// itself, all starting directions, opposite ones among them, have to lead to the same derivatives.
template <Number N>
std::optional<std::vector<typename OneSidedStart<N>::W>> OneSidedStart<N>::only_fixed_point(PresentStep<N>& step,
                                                                                            const W& h) const {
  if (!at_point_.empty()) return fixed_point(step, h, at_point_);
  const std::size_t size = step.series().program().unknowns();
  std::optional<std::vector<W>> found;
  std::vector<std::vector<W>> starts = {arbitrary<W>(size, 1), arbitrary<W>(size, -1)};
  for (std::size_t k = 0; k < starts.size(); ++k) {
    const auto a = fixed_point(step, h, starts[k]);
    if (!a) continue;
    if (found && difference(*found, *a) > kSame) return std::nullopt;
    if (found) continue;
    found = a;
    std::vector<W> opposite = *a;
    for (W& x : opposite) x = -x;
    starts.push_back(std::move(opposite));
  }
  return found;
}

template <Number N>
std::optional<std::vector<typename OneSidedStart<N>::W>> OneSidedStart<N>::take(PresentStep<N>& step,
                                                                                const W& h) const {
  auto a = only_fixed_point(step, h);
  const auto nearer = a ? only_fixed_point(step, h * W(0.5)) : std::nullopt;
  if (!nearer || difference(*a, *nearer) > kSame) return std::nullopt;
  step.expander.cut_to(step.track.now, *a);
  return a;
}

// If the equations have no value at the point, but the same one in an arbitrary direction at two distances from it, the
// hint says that the direction of the motion is not determined.
template <Number N>
Outcome OneSidedStart<N>::fault(PresentStep<N>& step, const W& h) const {
  Outcome o = fault_;
  const std::vector<W> somewhere = arbitrary<W>(step.series().program().unknowns(), 1);
  const auto a = leading_after(step, h, somewhere), nearer = leading_after(step, h * W(0.5), somewhere);
  if (at_point_.empty() && a && nearer && !(difference(*a, *nearer) > kSame))
    o.hint = "the equations do not determine in which direction the motion goes on here, or whether it does: give a "
             "small velocity in that direction, or, for a body "
             "that dry friction holds, put a function that is smooth at rest in place of unit(v) or sign(v), such as "
             "v/sqrt(norm2(v) + 1e-6) or tanh(v/0.001)";
  return o;
}

// The search has left a trial in the expansion, which the track's leading derivatives replace.
template <Number N>
Outcome OneSidedStart<N>::stop(PresentStep<N>& step, const W& h) {
  stopped_ = true;
  Outcome o = fault(step, h);
  step.expander.cut_to(step.track.now, step.track.now.leading);
  return o;
}

template class OneSidedStart<double>;
template class OneSidedStart<long double>;
template class OneSidedStart<Quad>;
template class OneSidedStart<Multi>;

}  // namespace anholon
