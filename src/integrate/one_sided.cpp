// The part of the stepper that goes on from where a formula has no derivatives along the motion, or no value: a root,
// norm or unit vector whose argument is zero there (theory: taylor, "One-sided starts").
//
// One step, so short that the leading derivatives a say all about it: x(h) = x + ... + a h^d/d!. They are those that
// the equations have at its end, a = G(a), found by iteration: so a formula is taken on the side that the motion
// enters. Where they are not determined that way (dry friction that holds, a thrust along a velocity that is zero), the
// outcome names the formula.
#include <algorithm>
#include <cmath>

#include "integrate/taylor.h"
#include "program/fault.h"

namespace anholon {

namespace {

// The neglected terms of a force like the square root of the time are then as large as the tolerance.
constexpr double kPartOfTolerance = 2.0 / 3;
constexpr int kRoundoffsOfTime = 32;
constexpr int kMostIterations = 60;
// Iterations end when they change this part of the leading derivatives; what depends on the step by more than kSame
// grows without bound at its start.
constexpr double kSettled = 1e-10, kSame = 0.05;
// A simple iteration goes on while it shrinks its changes to this part; Newton's differences are taken over this part
// of the derivatives.
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

// A direction that nothing in a model prefers.
template <Number W>
std::vector<W> arbitrary(std::size_t size, double sign) {
  std::vector<W> list;
  for (std::size_t j = 0; j < size; ++j)
    list.push_back(W(sign * (1 + 0.6180339887498949 * static_cast<double>(j % 5))));
  return list;
}

}  // namespace

// Parts of the times in which the lower derivatives change by their size, at least 1, as in step_size().
template <Number N>
typename Stepper<N>::W Stepper<N>::one_sided_step() const {
  const Program& p = *program_;
  double time = 1;
  for (int k = 0; k < *std::max_element(p.d.begin(), p.d.end()); ++k) {
    double size = 1;
    for (std::size_t j = 0; j < p.unknowns(); ++j)
      if (k < p.d[j]) size = std::max(size, std::abs(to_double(point_.derivative(j, k))));
    for (std::size_t j = 0; j < p.unknowns(); ++j)
      for (int i = k + 1; i <= p.d[j]; ++i)
        if (const double rate = std::abs(to_double(point_.derivative(j, i))); rate > 0 && std::isfinite(rate))
          time = std::min(time, std::pow(size / rate, 1.0 / (i - k)));
  }
  const W part = W(std::exp(settings_.log_tolerance * kPartOfTolerance)) * W(time),
          resolved = convert<W>(unit_roundoff<N>()) * W(kRoundoffsOfTime) * abs(t_);
  return part > resolved ? part : resolved;
}

// G: the leading derivatives that the equations have h beyond, on the polynomial that ends with these; nullopt where
// they have none.
template <Number N>
std::optional<std::vector<typename Stepper<N>::W>> Stepper<N>::leading_beyond(const W& h, std::vector<W> leading) {
  std::vector<N> narrow;
  convert_all(leading, narrow);
  expansion_.cut_to(narrow);
  point_.load(t_, state_, leading);
  Expansion<N>* there = ahead(h);
  if (!there || !there->solve().ok()) return std::nullopt;
  there->leading(narrow);
  convert_all(narrow, leading);
  return all_finite(leading) ? std::optional(std::move(leading)) : std::nullopt;
}

// A solution of a = G(a): by simple iteration as long as that contracts, by Newton's method with differences otherwise.
template <Number N>
std::optional<std::vector<typename Stepper<N>::W>> Stepper<N>::settled_leading(const W& h, std::vector<W> a) {
  const std::size_t size = a.size();
  double before = 0;
  for (int k = 0; k < kMostIterations; ++k) {
    const auto image = leading_beyond(h, a);
    if (!image) return std::nullopt;
    const double change = difference(*image, a);
    if (change < kSettled) return image;
    if (k == 0 || change < kContracts * before) {
      a = *image;
      before = change;
      continue;
    }
    before = change;
    const W step = largest(a) * W(kDifference);
    Matrix<W> slope(size, size);  // of a - G(a)
    std::vector<W> r(size), y;
    for (std::size_t j = 0; j < size; ++j) {
      std::vector<W> moved = a;
      moved[j] += step;
      const auto there = leading_beyond(h, moved);
      if (!there) return std::nullopt;
      for (std::size_t i = 0; i < size; ++i) slope(i, j) = (i == j ? W(1) : W(0)) - ((*there)[i] - (*image)[i]) / step;
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

// The one solution; nullopt if there is none or another one. Where the equations have no value at the point itself,
// every direction has to lead to the same derivatives, their opposite included.
template <Number N>
std::optional<std::vector<typename Stepper<N>::W>> Stepper<N>::one_sided_leading(const W& h) {
  if (!one_sided_->at_point.empty()) return settled_leading(h, one_sided_->at_point);
  const std::size_t size = program_->unknowns();
  std::optional<std::vector<W>> found;
  std::vector<std::vector<W>> starts = {arbitrary<W>(size, 1), arbitrary<W>(size, -1)};
  for (std::size_t k = 0; k < starts.size(); ++k) {
    const auto a = settled_leading(h, starts[k]);
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

// Ends the expansion with the leading derivatives for a step h of either sign; false if they are not determined, or
// grow without bound as h shrinks.
template <Number N>
bool Stepper<N>::take_one_sided(const W& h) {
  const auto a = one_sided_leading(h), nearer = a ? one_sided_leading(h * W(0.5)) : std::nullopt;
  if (!nearer || difference(*a, *nearer) > kSame) return false;
  leading_ = *a;
  std::vector<N> narrow;
  convert_all(leading_, narrow);
  expansion_.cut_to(narrow);
  point_.load(t_, state_, leading_);
  return true;
}

// Where the equations have no value at the point, but one beside it in every direction, it is the direction that is not
// determined.
template <Number N>
Outcome Stepper<N>::open_direction(const W& h) {
  Outcome o = one_sided_->fault;
  const std::vector<W> somewhere = arbitrary<W>(program_->unknowns(), 1);
  const auto a = leading_beyond(h, somewhere), nearer = leading_beyond(h * W(0.5), somewhere);
  if (one_sided_->at_point.empty() && a && nearer && !(difference(*a, *nearer) > kSame))
    o.hint = "the equations do not determine in which direction the motion goes on here, or whether it does: give a "
             "small velocity in that direction, or, for a body "
             "that dry friction holds, put a function that is smooth at rest in place of unit(v) or sign(v), such as "
             "v/sqrt(norm2(v) + 1e-6) or tanh(v/0.001)";
  return o;
}

// False where there is no such step in either direction of time: then the fault stands.
template <Number N>
bool Stepper<N>::expand_one_sided(Outcome& fault) {
  if (!all_finite(state_)) return false;
  one_sided_ = OneSided{fault, {}};
  if (!first_fault(*program_, expansion_.machine(), 0)) point_.leading(one_sided_->at_point);
  by_kernel_ = false;
  point_loaded_ = point_valued_ = true;
  const W h = one_sided_step();
  if (!take_one_sided(h) && !take_one_sided(-h)) {
    fault = open_direction(h);
    one_sided_.reset();
    return false;
  }
  horizon_ = convert<N>(h);
  expanded_ = true;
  return true;
}

template <Number N>
bool Stepper<N>::aims_one_sided(const W& left) {
  W h = convert<W>(horizon_);
  if (!(h < abs(left))) h = abs(left);
  if (left < W(0)) h = -h;
  if (!take_one_sided(h)) return fail(open_direction(h));
  singular_ahead_ = false;
  short_kinks_ = 0;
  at_kink_ = true;
  ++kinks_;
  fired_.clear();
  if (!events_.empty()) {
    N to = convert<N>(h);
    fired_ = events_.look(expansion_, order_ - 1, convert<N>(t_), to, std::nullopt,
                          [this](std::size_t i, const N& where) { return quadrature_ahead(i, where); });
    h = convert<W>(to);
  }
  const bool last = !(abs(h) < abs(left));
  aim_at(last ? W(t_ + left) : convert<W>(convert<N>(W(t_ + h))), last);
  return true;
}

#define INSTANTIATE(N)                                                                                                 \
  template Wider<N> Stepper<N>::one_sided_step() const;                                                                \
  template std::optional<std::vector<Wider<N>>> Stepper<N>::leading_beyond(const W&, std::vector<W>);                  \
  template std::optional<std::vector<Wider<N>>> Stepper<N>::one_sided_leading(const W&);                               \
  template std::optional<std::vector<Wider<N>>> Stepper<N>::settled_leading(const W&, std::vector<W>);                 \
  template bool Stepper<N>::take_one_sided(const W&);                                                                  \
  template Outcome Stepper<N>::open_direction(const W&);                                                               \
  template bool Stepper<N>::expand_one_sided(Outcome&);                                                                \
  template bool Stepper<N>::aims_one_sided(const W&);
INSTANTIATE(double)
INSTANTIATE(long double)
INSTANTIATE(Quad)
INSTANTIATE(Multi)
#undef INSTANTIATE

}  // namespace anholon
