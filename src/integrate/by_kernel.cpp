// The part of the stepper that makes its expansions by a kernel: of doubles, where nothing has to be looked at closely.
#include <algorithm>
#include <cmath>

#include "integrate/taylor.h"

namespace anholon {

namespace {

// Below this part of what they were where they were chosen, the pivots are no longer trusted.
constexpr double kHealthy = 0.02;
// The smallest singular value is looked at again whenever the pivots have become this much smaller.
constexpr double kNews = 0.8;

bool may_turn(const Instruction& in) {
  return in.op == Op::select || in.op == Op::lookup ||
         (in.op == Op::function && (in.index == static_cast<std::uint32_t>(Function::abs) || in.index == static_cast<std::uint32_t>(Function::sign)));
}

}  // namespace

template <Number N>
void Stepper<N>::accelerate(std::shared_ptr<const KernelPlan> plan) {
  if constexpr (std::same_as<N, double>) {
    const Tape& tape = program_->tape;
    const bool kinks = std::any_of(tape.code.begin(), tape.code.begin() + kinks_end(), [](const Instruction& in) { return !in.constant && may_turn(in); });
    if (!plan || kinks || !events_.empty()) return;
    kernel_ = std::make_unique<Kernel>(plan);
    kernel_->set_parameters(0, point_.parameters());
    for (const auto& [slot, place] : plan->plan().roots_of_even_powers) kink_series_.push_back({slot, place});
  } else {
    (void)plan;
  }
}

// False where the reference has to be asked.
template <Number N>
bool Stepper<N>::expand_by_kernel(const std::vector<W>& guess) {
  if constexpr (std::same_as<N, double>) {
    // The first expansion is the reference's, for the measure of how regular J is.
    if (!kernel_ || expansions_ < 2 || careful_) {
      careful_ = false;
      return false;
    }
    narrow_state_.resize(state_.size());
    for (std::size_t i = 0; i < state_.size(); ++i) narrow_state_[i] = static_cast<double>(state_[i]);
    narrow_leading_.resize(guess.size());
    for (std::size_t i = 0; i < guess.size(); ++i) narrow_leading_[i] = static_cast<double>(guess[i]);
    kernel_->load(0, static_cast<double>(t_), narrow_state_, narrow_leading_);
    kernel_->expand();
    const double health = kernel_->health(0);
    if (!(health > kHealthy) || health < least_health_ * kNews || !kernel_->finite(0)) {
      if (health < least_health_) least_health_ = std::max(health, 0.0);
      return false;
    }
    by_kernel_ = true;
    ++by_kernel_count_;
    const Program& p = *program_;
    if (kernel_->moved(0)) {
      std::size_t i = 0;
      for (std::size_t j = 0; j < p.unknowns(); ++j)
        for (int k = 0; k < p.d[j]; ++k, ++i)
          if (const double moved = kernel_->derivative(j, k) - narrow_state_[i]; moved != 0) state_[i] += moved, carry_[i] = 0;
    }
    leading_.resize(p.unknowns());
    for (std::size_t j = 0; j < p.unknowns(); ++j) leading_[j] = kernel_->derivative(j, p.d[j]);
    base_state_ = state_;
    point_loaded_ = point_valued_ = false;
    worst_constraint_ = std::max(worst_constraint_, W(kernel_->drift(0)));
    for (const auto& [slot, place] : kink_series_)
      for (int k = 0; k < order_; ++k) expansion_.adopt_coefficient(slot, k, kernel_->series(place, k));
    horizon_ = horizon_by_kernel();
    expanded_ = true;
    return true;
  } else {
    (void)guess;
    return false;
  }
}

// step_size(), on numbers that are at hand.
template <Number N>
N Stepper<N>::horizon_by_kernel() const {
  if constexpr (std::same_as<N, double>) {
    const Program& p = *program_;
    const int levels = *std::max_element(p.d.begin(), p.d.end());
    double log_rho = 300;
    for (int k = 0; k < levels; ++k) {
      double size = 1, last = 0, before_last = 0;
      for (std::size_t j = 0; j < p.unknowns(); ++j) {
        if (k >= p.d[j]) continue;
        size = std::max(size, std::abs(kernel_->derivative(j, k)));
        last = std::max(last, std::abs(kernel_->coefficient(j, order_ + k)));
        before_last = std::max(before_last, std::abs(kernel_->coefficient(j, order_ - 1 + k)));
      }
      double factor = 1, factor_before = 1;
      for (int i = 1; i <= k; ++i) factor *= order_ + i, factor_before *= order_ - 1 + i;
      if (last > 0) log_rho = std::min(log_rho, std::log(size / (last * factor)) / order_);
      if (before_last > 0) log_rho = std::min(log_rho, std::log(size / (before_last * factor_before)) / (order_ - 1));
    }
    double pole = 0;
    for (std::size_t j = 0; j < p.unknowns(); ++j)
      if (p.d[j] == 0)
        if (const double value = std::abs(kernel_->coefficient(j, 0)); value > 0) pole = std::max(pole, std::abs(kernel_->coefficient(j, order_ - 1)) / std::max(1.0, value));
    const double log_pole = pole > 0 ? -std::log(pole) / (order_ - 1) : 300;
    const double shrink = settings_.order > 0 ? -settings_.log_tolerance / order_ : 2.0;
    return std::exp(std::min(log_rho - shrink - 0.7 / (order_ - 1), log_pole - 0.7));
  } else {
    return N(0);
  }
}

template <Number N>
const Expansion<typename Stepper<N>::W>& Stepper<N>::point(bool values) const {
  if (!point_loaded_) {
    point_.load(begun_.t, base_state_, leading_at_base());
    point_loaded_ = true;
  }
  if (values && !point_valued_) {
    point_.evaluate();
    point_valued_ = true;
  }
  return point_;
}

template <Number N>
std::vector<typename Stepper<N>::W> Stepper<N>::leading_at_base() const {
  std::vector<W> leading(program_->unknowns());
  for (std::size_t j = 0; j < leading.size(); ++j) leading[j] = W(kernel_->derivative(j, program_->d[j]));
  return leading;
}

#define INSTANTIATE(N)                                                     \
  template void Stepper<N>::accelerate(std::shared_ptr<const KernelPlan>); \
  template bool Stepper<N>::expand_by_kernel(const std::vector<W>&);       \
  template N Stepper<N>::horizon_by_kernel() const;                        \
  template const Expansion<Wider<N>>& Stepper<N>::point(bool) const;       \
  template std::vector<Wider<N>> Stepper<N>::leading_at_base() const;
INSTANTIATE(double)
INSTANTIATE(long double)
INSTANTIATE(Quad)
INSTANTIATE(Multi)
#undef INSTANTIATE

}  // namespace anholon
