#include "integrate/taylor.h"

#include <algorithm>
#include <cmath>

namespace anholon {

namespace {

// Steps smaller than this many round-offs of the time are a collapse.
constexpr int kCollapsedRoundoffs = 16;
constexpr double kBlowUp = 1e100;

// s + x with the round-off kept in `carry`.
template <Number N>
void add_compensated(N& s, N& carry, const N& x) {
  const N y = x + carry, sum = s + y;
  carry = abs(s) >= abs(y) ? N(N(s - sum) + y) : N(N(y - sum) + s);
  s = sum;
}

}  // namespace

int taylor_order(double tolerance) {
  return std::max(4, static_cast<int>(std::ceil(-std::log(tolerance) / 2 + 1)));
}

template <Number N>
Stepper<N>::Stepper(const Program& program, const std::vector<N>& parameters, const StepSettings& settings)
    : program_(&program), settings_(settings), order_(settings.order > 0 ? settings.order : taylor_order(settings.tolerance)),
      expansion_(program, parameters, order_ - 1) {}

template <Number N>
Outcome Stepper<N>::start(const N& t, const std::vector<N>& state, const std::vector<N>& leading) {
  t_ = before_ = t;
  state_ = state;
  carry_.assign(state.size(), N(0));
  integrals_.assign(program_->quadratures, N(0));
  integral_carry_ = integrals_;
  steps_ = 0;
  leading_ = leading;
  return expand(leading_);
}

template <Number N>
Outcome Stepper<N>::expand(const std::vector<N>& guess) {
  expansion_.load(t_, state_, guess);
  if (Outcome o = expansion_.prepare(); !o.ok()) return o;
  if (Outcome o = expansion_.project(); !o.ok()) return o;
  if (Outcome o = expansion_.solve(); !o.ok()) return o;
  const std::vector<N> unprojected = state_;
  expansion_.state(state_);
  for (std::size_t i = 0; i < state_.size(); ++i)
    if (state_[i] != unprojected[i]) carry_[i] = N(0);
  expansion_.leading(leading_);
  if (expansion_.constraint_residual() > worst_constraint_) worst_constraint_ = expansion_.constraint_residual();
  if (expansion_.equation_residual() > worst_equation_) worst_equation_ = expansion_.equation_residual();
  if (N sigma = expansion_.smallest_singular_value(); sigma < smallest_sigma_) smallest_sigma_ = sigma;
  if (Outcome o = expansion_.extend(); !o.ok()) return o;
  horizon_ = step_size();
  return {};
}

// h = (rho / e^2) exp(-0.7/(p-1)), rho the smaller root of |x| / |x_k| for the last two orders k,
// in the greatest norm over the state, relative to its size but at least 1 (Jorba & Zou 2005).
template <Number N>
N Stepper<N>::step_size() const {
  const Program& p = *program_;
  constexpr double kNothing = -1e300;  // the logarithm of zero
  double size = 1, last = kNothing, before_last = kNothing;
  for (std::size_t j = 0; j < p.unknowns(); ++j)
    for (int k = 0; k < p.d[j]; ++k) {
      size = std::max(size, std::abs(to_double(expansion_.derivative(j, k))));
      const auto coefficient = [&](int order) {  // of x_j^(k)
        double factor = 1;
        for (int i = 1; i <= k; ++i) factor *= order + i;
        // Logarithms: coefficients of high order may leave the range of double.
        const N v = abs(expansion_.coefficient(j, order + k));
        return v > N(0) ? static_cast<double>(to_double(N(log(v)))) + std::log(factor) : kNothing;
      };
      last = std::max(last, coefficient(order_));
      before_last = std::max(before_last, coefficient(order_ - 1));
    }
  const double ls = std::log(size);
  const double log_rho = std::min((ls - last) / order_, (ls - before_last) / (order_ - 1));
  // e^-2 per order suits order = -ln(tol)/2 + 1; another order keeps h^p rho^-p = tol.
  const double shrink = settings_.order > 0 ? -std::log(settings_.tolerance) / order_ : 2.0;
  const double log_h = std::min(log_rho, 300.0) - shrink - 0.7 / (order_ - 1);
  return N(std::exp(log_h));
}

template <Number N>
void Stepper<N>::polynomial(const N& h, std::vector<N>& increments, std::vector<N>& leading) const {
  const Program& p = *program_;
  increments.assign(expansion_.state_size(), N(0));
  leading.assign(p.unknowns(), N(0));
  for (std::size_t j = 0; j < p.unknowns(); ++j) {
    const int top = order_ - 1 + p.d[j];
    for (int k = 0; k <= p.d[j]; ++k) {
      // sum_i x_(k+i) (k+i)!/i! h^i, without the term of order 0 (that is the state itself).
      N s(0);
      for (int i = top - k; i >= 1; --i) {
        N factor(1);
        for (int f = 1; f <= k; ++f) factor = factor * N(i + f);
        s = (s + expansion_.coefficient(j, k + i) * factor) * h;
      }
      if (k < p.d[j]) increments[expansion_.offset(j) + static_cast<std::size_t>(k)] = s;
      else leading[j] = expansion_.derivative(j, k) + s;
    }
  }
}

template <Number N>
Outcome Stepper<N>::step(const N& end) {
  if (settings_.cancelled && settings_.cancelled())
    return {OutcomeKind::interrupted, "interrupted", "what was computed is kept"};
  if (steps_ >= settings_.most_steps)
    return {OutcomeKind::interrupted, "the step limit is reached", "allow more steps, or loosen the tolerance"};
  // The first call expands at the start; each later one where the step before ended.
  if (steps_ > 0)
    if (Outcome o = expand(leading_); !o.ok()) return o;
  const N left = end - t_;
  const bool forward = left > N(0);
  N h = horizon_;
  const N floor = unit_roundoff<N>() * N(kCollapsedRoundoffs) * (abs(t_) > abs(left) ? abs(t_) : abs(left));
  if (!(h > floor))
    return {OutcomeKind::step_collapse, "the step size fell below what the time can resolve",
            "the motion approaches a singularity: stop before it, or look at the last good state"};
  const bool last = !(h < abs(left));
  if (last) h = abs(left);
  if (!forward) h = -h;
  // The step that t can show exactly: otherwise the time loses a round-off at every step.
  const N reached = last ? end : N(t_ + h);
  h = reached - t_;

  std::vector<N> increments;
  polynomial(h, increments, leading_);
  std::vector<N> next = state_;
  for (std::size_t i = 0; i < next.size(); ++i) {
    add_compensated(next[i], carry_[i], increments[i]);
    if (!is_finite(next[i]) || std::abs(to_double(next[i])) > kBlowUp)
      return {OutcomeKind::blow_up, "the motion grows without bound", "look at the last good state: a velocity or position diverges"};
  }
  for (std::size_t i = 0; i < integrals_.size(); ++i) {
    const N* series = expansion_.quadrature(i);
    N s(0);
    for (int k = order_ - 1; k >= 0; --k) s = (s + series[k] / N(k + 1)) * h;
    add_compensated(integrals_[i], integral_carry_[i], s);
  }
  before_ = t_;
  t_ = reached;
  state_ = std::move(next);
  ++steps_;
  return {};
}

template <Number N>
Outcome Stepper<N>::at(const N& t, Expansion<N>& point) const {
  std::vector<N> state, increments, leading;
  expansion_.state(state);
  polynomial(t - before_, increments, leading);
  for (std::size_t i = 0; i < state.size(); ++i) state[i] += increments[i];
  point.load(t, state, leading);
  if (Outcome o = point.prepare(); !o.ok()) return o;
  if (Outcome o = point.project(); !o.ok()) return o;
  return point.solve();
}

template class Stepper<double>;
template class Stepper<long double>;
template class Stepper<Multi>;

}  // namespace anholon
