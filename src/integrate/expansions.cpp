// The part of the stepper that makes its expansions, by the kernel or the reference, and says how far they reach.
#include <algorithm>
#include <cmath>

#include "integrate/kink.h"
#include "integrate/taylor.h"
#include "kernel/kernel.h"

namespace anholon {

// So many round-offs of what it was at the start a singular value of J may fall to: below, fewer than six digits are
// left of a solution.
static constexpr double kNoDigits = 1e6;

template <Number N>
Outcome Stepper<N>::expand(const std::vector<W>& guess) {
  if (!alone_) record_.careful = true;  // those beside it in the kernel are left in peace
  begin_expansion(guess);
  if (loaded_) kernel_->begin();
  return outcome(ends_expansion(guess));
}

template <Number N>
void Stepper<N>::begin_expansion(const std::vector<W>& guess) {
  loaded_ = kernel_serves();
  if (!loaded_) settle();
  now_ = 1 - now_;
  note_begun(guess);
  suspected_ = record_.careful = false;
  if (loaded_) load_kernel(guess);
}

// Ends what was begun.
template <Number N>
bool Stepper<N>::ends_expansion(const std::vector<W>& guess) {
  const bool again = expansions_++ > 0, by_kernel = loaded_ && take_from_kernel();
  if (loaded_ && !by_kernel) settle_as_begun();
  loaded_ = false;
  if (by_kernel && !suspected_) return true;
  Outcome o = by_kernel ? Outcome{} : expand_by_reference(guess);
  if (o.ok() && suspected_)
    o = look_back();
  else if (!o.ok() && again)
    expand_again(StepperState<N>(settled(1 - now_)));
  return o.ok() || fail(std::move(o));
}

// Where the kernel belongs to others, too, it is left in peace.
template <Number N>
Outcome Stepper<N>::expand_here(const std::vector<W>& guess) {
  loaded_ = alone_ && kernel_serves();
  note_begun(guess);
  record_.careful = false;
  ++expansions_;
  if (loaded_) {
    load_kernel(guess);
    kernel_->begin();
    if (take_from_kernel()) return loaded_ = false, Outcome{};
    settle_as_begun();
  }
  loaded_ = false;
  return expand_by_reference(guess);
}

// Whether J was singular within the last step is asked of the reference: at both ends first.
template <Number N>
Outcome Stepper<N>::look_back() {
  settle();
  const std::optional<Mode<N>> before = mode_at(begun_[1 - now_].t, settled(1 - now_).state),
                               here = mode_at(t_, state_);
  if (before && here && !crossed(*before, *here, program_->system->coordinates)) return {};
  const StepperState<N> now = settled(now_), last = settled(1 - now_);
  const W length = record_.last_step;
  record_.careful = true;
  expand_again(last);
  record_.last_step = W(0);
  const std::optional<W> met = singular_within(now.t - last.t);
  record_.last_step = length;
  if (met)
    return {OutcomeKind::singular,
            "the system Jacobian becomes singular at t = " + number_text(to_double(W(last.t + *met)), 12),
            "end the motion before"};
  record_.careful = true;
  const Outcome o = expand_here(now.leading);
  begun_[now_] = now;
  begun_[1 - now_] = last;
  return o;
}

// After a failure: the polynomial of the last good step is still asked for.
template <Number N>
void Stepper<N>::expand_again(const StepperState<N>& last) {
  const W t = t_;
  const std::vector<W> state = state_, carry = carry_, leading = leading_, own = own_, own_leading = own_leading_;
  t_ = before_ = last.t;
  state_ = last.state;
  own_ = last.own;
  own_leading_ = last.own_leading;
  carry_ = last.carry;
  carried_ = false;
  expand_here(last.leading);
  settle();
  base_state_ = state_;
  begun_[now_] = last;
  t_ = t;
  state_ = state;
  own_ = own;
  own_leading_ = own_leading;
  carry_ = carry;
  carried_ = false;
  leading_ = leading;
  expanded_ = false;
}

template <Number N>
void Stepper<N>::note_begun(const std::vector<W>& guess) {
  StepperState<N>& b = begun_[now_];
  begun_by_kernel_[now_] = loaded_;
  b.t = t_;
  if (loaded_ && mapped()) b.state.clear();
  if (!loaded_) {
    b.state = state_;
    b.carry = carry_;
    b.leading = guess;
    b.own.clear();
  }
  if (!integrals_.empty()) {
    b.integrals = integrals_;
    b.integral_carry = integral_carry_;
  }
  static_cast<StepperRecord<N>&>(b) = record_;
}

// Expansions by the kernel change neither the direction nor the sides.
template <Number N>
const StepperState<N>& Stepper<N>::begun() const {
  settle();
  if (by_kernel_) begun_[now_].direction = expansion_.weakest_direction(), begun_[now_].sides = events_.sides();
  return settled(now_);
}

template <Number N>
Outcome Stepper<N>::expand_by_reference(const std::vector<W>& guess) {
  one_sided_.reset();
  Outcome o = expand_regularly(guess);
  return o.kind == OutcomeKind::not_a_number && expand_one_sided(o) ? Outcome{} : o;
}

template <Number N>
Outcome Stepper<N>::expand_regularly(const std::vector<W>& guess) {
  begun_[now_].direction = expansion_.weakest_direction();
  begun_[now_].sides = events_.sides();
  own_.clear();
  by_kernel_ = carried_ = false;
  point_loaded_ = point_valued_ = true;
  convert_all(state_, narrow_state_);
  convert_all(guess, narrow_leading_);
  expansion_.load(convert<N>(t_), narrow_state_, narrow_leading_);
  if (Outcome o = expansion_.prepare(); !o.ok()) return o;
  sigma_ = expansion_.smallest_singular_value();
  note_sigma(sigma_);
  // Steps shrink towards where constraints lose their hold, and would come out on the other side, with one motion of
  // several. Where coordinates are singular (Euler's angles) there is one.
  const std::vector<N>& v = expansion_.weakest_direction();
  const auto larger = [](const N& a, const N& b) { return abs(a) < abs(b); };
  const bool of_constraints = std::max_element(v.begin(), v.end(), larger) - v.begin() >=
                              static_cast<std::ptrdiff_t>(program_->system->coordinates);
  if (of_constraints && sigma_ < record_.first_sigma * unit_roundoff<N>() * N(kNoDigits))
    return {OutcomeKind::singular, "the system Jacobian becomes singular", "end the motion before"};
  point_.load(t_, state_, guess);
  if constexpr (std::same_as<N, W>) {
    if (Outcome o = expansion_.project(); !o.ok()) return o;
    if (Outcome o = expansion_.solve(); !o.ok()) return o;
    const std::vector<W> unprojected = state_;
    expansion_.state(state_);
    for (std::size_t i = 0; i < state_.size(); ++i)
      if (state_[i] != unprojected[i]) carry_[i] = W(0);
    expansion_.leading(leading_);
    point_.load(t_, state_, leading_);
    record_.worst_constraint = std::max(record_.worst_constraint, expansion_.drift());
    record_.worst_equation = std::max(record_.worst_equation, expansion_.equation_residual());
  } else {
    const auto solver = [this](const std::vector<W>& r, std::vector<W>& y) {
      convert_all(r, narrow_r_);
      expansion_.lu().solve_once(narrow_r_, narrow_y_);
      convert_all(narrow_y_, y);
    };
    point_.evaluate();
    point_.adopt_jacobian(expansion_.system_jacobian());
    if (Outcome o = point_.project(solver); !o.ok()) return o;
    if (Outcome o = point_.solve(solver); !o.ok()) {
      // The Jacobian moves with the leading derivatives: solve for them in N first.
      if (o = expansion_.solve(); !o.ok()) return o;
      expansion_.leading(narrow_leading_);
      convert_all(narrow_leading_, leading_);
      point_.load(t_, state_, leading_);
      point_.evaluate();
      if (o = point_.project(solver); !o.ok()) return o;
      if (o = point_.solve(solver); !o.ok()) return o;
    }
    point_.state(state_);
    point_.leading(leading_);
    expansion_.adopt_values(point_);
    record_.worst_constraint = std::max(record_.worst_constraint, point_.drift());
    record_.worst_equation = std::max(record_.worst_equation, point_.equation_residual());
  }
  if (Outcome o = expansion_.extend(); !o.ok()) return o;
  horizon_ = step_size();
  // What is watched may change faster than the motion, on which it has no influence: the density of thin air.
  const double reach =
      std::min(kinks_log_reach<N>(expansion_.machine(), kinks_end(), order_ - 1, settings_.log_tolerance),
               events_.log_reach(expansion_, order_ - 1, settings_.log_tolerance));
  if (const N known(std::exp(reach)); known < horizon_) horizon_ = known;
  heed_integrals();
  expanded_ = true;
  return {};
}

// h = (rho / e^shrink) exp(-0.7/(p-1)), rho the smaller root of |x| / |x_k| for the last two orders k,
// in the greatest norm, relative to the size of x but at least 1 (Jorba & Zou 2005). Positions,
// velocities, … are measured each against their own size: an angle that has turned a thousand times
// must not loosen the tolerance of the velocities.
template <Number N>
N Stepper<N>::step_size() const {
  const Program& p = *program_;
  constexpr double kNothing = -1e300;  // the logarithm of zero
  double last_weight = kNothing, before_weight = kNothing;
  const int levels = *std::max_element(p.d.begin(), p.d.end());
  for (int k = 0; k < levels; ++k) {
    double size = 1, last = kNothing, before_last = kNothing;
    for (std::size_t j = 0; j < p.unknowns(); ++j) {
      if (k >= p.d[j]) continue;
      size = std::max(size, std::abs(to_double(expansion_.derivative(j, k))));
      const auto coefficient = [&](int order) {  // of x_j^(k)
        double factor = 1;
        for (int i = 1; i <= k; ++i) factor *= order + i;
        // Logarithms: coefficients of high order may leave the range of double.
        const N v = abs(expansion_.coefficient(j, order + k));
        return v > N(0) ? to_double(N(log(v))) + std::log(factor) : kNothing;
      };
      last = std::max(last, coefficient(order_));
      before_last = std::max(before_last, coefficient(order_ - 1));
    }
    last_weight = std::max(last_weight, last - std::log(size));
    before_weight = std::max(before_weight, before_last - std::log(size));
  }
  // Multipliers that are no states carry no error on, but a step must not pass a pole of theirs,
  // where a constraint loses its hold: it stays within half of their radius of convergence.
  double pole = kNothing;
  for (std::size_t j = 0; j < p.unknowns(); ++j) {
    if (p.d[j] > 0) continue;
    const N top = abs(expansion_.coefficient(j, order_ - 1)), value = abs(expansion_.coefficient(j, 0));
    if (!(top > N(0)) || !(value > N(0))) continue;
    pole = std::max(pole, to_double(N(log(top))) - std::max(0.0, to_double(N(log(value)))));
  }
  constexpr double kFar = 300;
  const double log_rho = std::min({kFar, -last_weight / order_, -before_weight / (order_ - 1)}),
               log_pole = std::min(kFar, -pole / (order_ - 1));
  return N(std::exp(std::min(log_rho - shrink() - 0.7 / (order_ - 1), log_pole - 0.7)));
}

// An integral along the motion carries no error on, but it is to be as good as the motion. A power is a product: where
// the motion is smooth everywhere (an oscillator) its series converges much more slowly. The last two terms over the
// step stay below the tolerance, in relation to the first three, to the integral so far and to 1.
template <Number N>
void Stepper<N>::heed_integrals() {
  for (std::size_t i = 0; i < std::min(settings_.integrals, integrals_.size()); ++i) {
    const double h = to_double(horizon_);
    const auto coefficient = [&](int k) { return std::abs(to_double(quadrature_coefficient(i, k))); };
    double power = 1, square = h;
    for (int p = order_ - 1; p > 0; p >>= 1, square *= square)
      if (p & 1) power *= square;
    const double whole = std::max(1.0, std::abs(to_double(integrals_[i]))),
                 tail = power * std::max(coefficient(order_ - 1) * h / order_, coefficient(order_ - 2) / (order_ - 1));
    const double first = h * std::max({coefficient(0), coefficient(1) * h / 2, coefficient(2) * h * h / 3});
    if (tail <= std::exp(settings_.log_tolerance) * std::max(whole, first)) continue;
    // Closely; what leaves the range of double has a logarithm.
    constexpr double kNothing = -1e300;
    const double log_h = to_double(N(log(horizon_)));
    const auto term = [&](int k) {
      const N c = abs(quadrature_coefficient(i, k));
      return c > N(0) ? to_double(N(log(c))) + (k + 1) * log_h - std::log(k + 1) : kNothing;
    };
    const double excess = std::max(term(order_ - 1), term(order_ - 2)) - settings_.log_tolerance -
                          std::max({std::log(whole), term(0), term(1), term(2)});
    if (excess > 0) horizon_ *= N(std::exp(-excess / order_));
  }
}

// (h / rho)^p is what e^-2 per order makes for the order of Jorba & Zou, a whole number: tol / e^2 or less.
template <Number N>
double Stepper<N>::shrink() const {
  return 2.0 * least_work_order(settings_.log_tolerance) / order_;
}

#define INSTANTIATE(N)                                                                                                 \
  template Outcome Stepper<N>::expand(const std::vector<W>&);                                                          \
  template void Stepper<N>::begin_expansion(const std::vector<W>&);                                                    \
  template bool Stepper<N>::ends_expansion(const std::vector<W>&);                                                     \
  template Outcome Stepper<N>::expand_here(const std::vector<W>&);                                                     \
  template Outcome Stepper<N>::look_back();                                                                            \
  template void Stepper<N>::expand_again(const StepperState<N>&);                                                      \
  template void Stepper<N>::note_begun(const std::vector<W>&);                                                         \
  template const StepperState<N>& Stepper<N>::begun() const;                                                           \
  template Outcome Stepper<N>::expand_by_reference(const std::vector<W>&);                                             \
  template Outcome Stepper<N>::expand_regularly(const std::vector<W>&);                                                \
  template N Stepper<N>::step_size() const;                                                                            \
  template void Stepper<N>::heed_integrals();                                                                          \
  template double Stepper<N>::shrink() const;
INSTANTIATE(double)
INSTANTIATE(long double)
INSTANTIATE(Quad)
INSTANTIATE(Multi)
#undef INSTANTIATE

}  // namespace anholon
