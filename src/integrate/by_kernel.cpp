// The part of the stepper that makes its expansions by a kernel: of doubles, where nothing has to be looked at closely.
#include <algorithm>
#include <cmath>
#include <utility>

#include "integrate/kink.h"
#include "integrate/passed_over.h"
#include "integrate/taylor.h"
#include "kernel/kernel.h"

namespace anholon {

namespace {

bool may_turn(const Instruction& in) {
  return in.op == Op::select || in.op == Op::lookup ||
         (in.op == Op::function && (in.index == static_cast<std::uint32_t>(Function::abs) ||
                                    in.index == static_cast<std::uint32_t>(Function::sign)));
}

}  // namespace

template <Number N>
void Stepper<N>::accelerate(std::shared_ptr<const KernelPlan> plan) {
  if constexpr (std::same_as<N, double>) {
    if (!plan) return;
    auto kernel = std::make_shared<Kernel>(std::move(plan));
    kernel->set_parameters(0, point_.parameters());
    accelerate(std::move(kernel), 0);
  } else {
    (void)plan;
  }
}

template <Number N>
void Stepper<N>::accelerate(std::shared_ptr<Kernel> kernel, int lane) {
  if constexpr (std::same_as<N, double>) {
    const Tape& tape = program_->tape;
    const bool kinks = std::any_of(tape.code.begin(), tape.code.begin() + kinks_end(),
                                   [](const Instruction& in) { return !in.constant && may_turn(in); });
    if (kinks || !events_.empty()) return;
    settle();
    kernel_ = std::move(kernel);
    lane_ = lane;
    alone_ = kernel_->lanes() == 1;
    kernel_->set_shrink(shrink());
    kink_series_.clear();
    own_.clear();
    // The roots of a kernel with unknowns of its own are its own, too: of what J keeps from zero.
    if (mapped()) return;
    for (const auto& [slot, place] : kernel_->plan().plan().roots_of_even_powers)
      kink_series_.push_back({slot, place.at});
  } else {
    (void)kernel, (void)lane;
  }
}

// Not where the reference has to be asked: some expansions are its own, for the measure of how regular J is: the first,
// others ever more rarely, and see below.
template <Number N>
bool Stepper<N>::kernel_serves() const {
  if constexpr (std::same_as<N, double>) {
    const bool look = settings_.measure && (record_.first_sigma == 0 || due_for_a_look(record_.steps));
    return kernel_ && !look && !record_.careful;
  } else {
    return false;
  }
}

template <Number N>
void Stepper<N>::load_kernel(const std::vector<W>& guess) {
  if constexpr (std::same_as<N, double>) {
    if (!away_) {
      if (!carried_)
        for (std::size_t i = 0; i < state_.size(); ++i) state_[i] += std::exchange(carry_[i], W(0));
      carried_ = true;
      if (!mapped()) {
        kernel_->place(lane_, state_, guess);
      } else {
        if (own_.empty()) {
          kernel_->reader(lane_).own(t_, state_, own_);
          own_leading_.clear();
        }
        kernel_->place(lane_, own_, own_leading_);
        // Where the map has no value, this is all that is left.
        begun_[now_].state = state_;
      }
      away_ = true;
    }
    kernel_->set_time(lane_, static_cast<double>(t_));
  } else {
    (void)guess;
  }
}

// What is with the kernel is fetched. Its last two expansions, too; while one is being made, there is nothing to
// settle.
template <Number N>
void Stepper<N>::settle() const {
  if constexpr (std::same_as<N, double>) {
    if (!away_) return;
    away_ = false;
    if (mapped()) {
      kernel_->fetch(lane_, Kernel::Moment::now, own_, own_leading_);
      read(t_, own_, state_);
    } else {
      kernel_->fetch(lane_, Kernel::Moment::now, state_, leading_);
    }
    if (expanded_ || mapped()) leading_ = leading_at_base();
    if (!expanded_ && !mapped()) kernel_->fetch_base(lane_, base_state_);
    for (const int i : {0, 1})
      if (StepperState<N>& b = begun_[i]; begun_by_kernel_[i]) {
        const Kernel::Moment moment = i == now_ ? Kernel::Moment::begun : Kernel::Moment::before;
        if (mapped()) {
          kernel_->fetch(lane_, moment, b.own, b.own_leading);
          b.leading.assign(program_->unknowns(), W(0));
        } else {
          kernel_->fetch(lane_, moment, b.state, b.leading);
        }
        b.carry.assign(state_.size(), W(0));
      }
  }
}

// Of the present expansion, or the one before.
template <Number N>
StepperState<N>& Stepper<N>::settled(int which) const {
  StepperState<N>& b = begun_[which];
  if (b.state.empty() && !b.own.empty()) read(b.t, b.own, b.state);
  return b;
}

template <Number N>
bool Stepper<N>::mapped() const {
  return kernel_ && kernel_->plan().map();
}

template <Number N>
void Stepper<N>::read(const W& t, const std::vector<W>& own, std::vector<W>& state) const {
  if constexpr (std::same_as<N, double>) kernel_->reader(lane_).motion(t, own, state);
}

// Where the kernel's expansion was made.
template <Number N>
void Stepper<N>::fetch_own_base(std::vector<W>& own) const {
  if constexpr (std::same_as<N, double>) kernel_->fetch_base(lane_, own);
}

template <Number N>
void Stepper<N>::fetch_base(std::vector<W>& state) const {
  if (!mapped()) return fetch_own_base(state);
  std::vector<W> own;
  fetch_own_base(own);
  read(begun_[now_].t, own, state);
}

// The kernel has failed in the present expansion.
template <Number N>
void Stepper<N>::settle_as_begun() {
  if constexpr (std::same_as<N, double>) {
    settle();
    state_ = settled(now_).state;
    leading_ = begun_[now_].leading;
    own_.clear();
  }
}

// The kernel's step is not to be.
template <Number N>
void Stepper<N>::settle_at_base() {
  if constexpr (std::same_as<N, double>) {
    settle();
    fetch_base(state_);
    leading_ = leading_at_base();
    own_.clear();
  }
}

template <Number N>
bool Stepper<N>::take_from_kernel() {
  if constexpr (std::same_as<N, double>) {
    const Pivots pivots = kernel_->pivots(lane_);
    const double health = pivots.health;
    suspected_ = by_kernel_ && may_have_vanished(pivots_before_, pivots);
    pivots_before_ = pivots;
    if (!(health > trusted_health()) || (settings_.measure && health < record_.least_health * kNewsOfPivots) ||
        !kernel_->reaches(lane_)) {
      record_.least_health = std::min(record_.least_health, health);
      return false;
    }
    by_kernel_ = expanded_ = true;
    one_sided_.reset();
    ++by_kernel_count_;
    point_loaded_ = point_valued_ = false;
    if (const W drift(kernel_->drift(lane_)); record_.worst_constraint < drift) record_.worst_constraint = drift;
    horizon_ = kernel_->reach(lane_);
    heed_integrals();
    show_roots();
    return true;
  } else {
    return false;
  }
}

// Who asks for the last digits gets them from the reference, which refines its solutions in wider numbers, where an
// elimination begins to lose some.
template <Number N>
double Stepper<N>::trusted_health() const {
  constexpr double kLosesNone = 0.25;
  return asks_for_last_digits(settings_.log_tolerance) && !mapped() ? kLosesNone : kHealthy;
}

// Of what may touch zero within the step, the series are shown to those who look.
template <Number N>
void Stepper<N>::show_roots() {
  if constexpr (std::same_as<N, double>) {
    may_touch_zero_ = false;
    for (const auto& [slot, at] : kink_series_) {
      narrow_y_.resize(static_cast<std::size_t>(order_));
      for (int k = 0; k < order_; ++k) narrow_y_[static_cast<std::size_t>(k)] = kernel_->series({at, true}, k, lane_);
      may_touch_zero_ = may_touch_zero_ || !stays_positive(narrow_y_.data(), order_ - 1, horizon_);
    }
    if (!may_touch_zero_) return;
    for (const auto& [slot, at] : kink_series_)
      for (int k = 0; k < order_; ++k) expansion_.adopt_coefficient(slot, k, kernel_->series({at, true}, k, lane_));
  }
}

template <Number N>
const Expansion<typename Stepper<N>::W>& Stepper<N>::point(bool values) const {
  if (!point_loaded_) {
    settle();
    if (mapped() && by_kernel_ && !expanded_) fetch_base(base_state_);
    point_.load(begun_[now_].t, expanded_ ? state_ : base_state_, leading_at_base());
    point_loaded_ = true;
    // The kernel knows no multipliers.
    if (mapped() && point_.prepare().ok()) point_.solve();
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
  kernel_->show_last();
  for (std::size_t j = 0; j < leading.size(); ++j)
    if (const auto own = kernel_unknown(j)) leading[j] = W(kernel_->derivative(*own, program_->d[j], lane_));
  return leading;
}

// Of the motion's unknown j; a kernel with unknowns of its own has no multipliers.
template <Number N>
std::optional<std::size_t> Stepper<N>::kernel_unknown(std::size_t j) const {
  return mapped() ? kernel_->plan().map()->own(j, program_->unknowns()) : std::optional<std::size_t>(j);
}

template <Number N>
N Stepper<N>::coefficient(std::size_t j, int k) const {
  if constexpr (std::same_as<N, double>)
    if (by_kernel_) {
      kernel_->show_last();
      const auto own = kernel_unknown(j);
      return own && k <= kernel_->plan().plan().stages + kernel_->plan().plan().d[*own]
                 ? kernel_->coefficient(*own, k, lane_)
                 : 0;
    }
  return expansion_.coefficient(j, k);
}

template <Number N>
N Stepper<N>::quadrature_coefficient(std::size_t i, int k) const {
  if constexpr (std::same_as<N, double>)
    if (by_kernel_) return kernel_->show_last(), kernel_->quadrature(i, k, lane_);
  return expansion_.quadrature(i)[k];
}

template <Number N>
void Stepper<N>::find_hidden_by_kernel(const N& h) {
  if constexpr (std::same_as<N, double>) {
    const Plan& plan = kernel_->plan().plan();
    if (plan.hiding.empty()) return;
    kernel_->show_last();
    std::vector<double> argument(static_cast<std::size_t>(order_)), value = argument;
    for (const Plan::HidingSlot& slot : plan.hiding) {
      for (int k = 0; k < order_; ++k) {
        argument[static_cast<std::size_t>(k)] = kernel_->series(slot.argument, k, lane_);
        value[static_cast<std::size_t>(k)] = kernel_->series(slot.value, k, lane_);
      }
      add_hidden(slot.function, argument.data(), value.data(), order_ - 1, h, hidden_);
    }
  } else {
    (void)h;
  }
}

template <Number N>
N Stepper<N>::defect_by_kernel() const {
  if constexpr (std::same_as<N, double>)
    return kernel_->defect(lane_);
  else
    return N(0);
}

template <Number N>
void Stepper<N>::advance_kernel(const W& h) const {
  kernel_->set_step(lane_, to_double(h));
  kernel_->change_over_step();
}

// The solution h beyond where the expansion was made, in the unknowns of the kernel. What the kernel does not see of
// the wider state is added: t_i h^(i-k) / (i-k)!.
template <Number N>
void Stepper<N>::advanced_by_kernel(const W& h, const std::vector<W>& base, std::vector<W>& state,
                                    std::vector<W>& leading) const {
  if constexpr (std::same_as<N, double>) {
    kernel_->show_last();
    const Program& p = kernel_->plan().program();
    const std::size_t stride = static_cast<std::size_t>(kernel_->lanes());
    const double *increment = kernel_->increments(lane_), *factorial = kernel_->plan().tables().factorial.data();
    state.resize(base.size());
    leading.resize(p.unknowns());
    const W* from = base.data();
    W* to = state.data();
    for (std::size_t j = 0; j < p.unknowns(); ++j) {
      const double* x = kernel_->unknown(j, lane_);
      const int d = p.d[j];
      for (int k = 0; k < d; ++k, increment += stride) {
        W s = from[k] + *increment, power = h;
        for (int i = k + 1; i < d; ++i) {
          s += (from[i] - W(x[static_cast<std::size_t>(i) * stride] * factorial[i])) * power;
          power *= h / W(i - k + 1);
        }
        to[k] = s;
      }
      leading[j] = x[static_cast<std::size_t>(d) * stride] * factorial[d] + *increment;
      increment += stride;
      from += d;
      to += d;
    }
  } else {
    (void)h, (void)base, (void)state, (void)leading;
  }
}

#define INSTANTIATE(N)                                                                                                 \
  template N Stepper<N>::coefficient(std::size_t, int) const;                                                          \
  template N Stepper<N>::quadrature_coefficient(std::size_t, int) const;                                               \
  template void Stepper<N>::find_hidden_by_kernel(const N&);                                                           \
  template N Stepper<N>::defect_by_kernel() const;                                                                     \
  template void Stepper<N>::advance_kernel(const W&) const;                                                            \
  template void Stepper<N>::advanced_by_kernel(const W&, const std::vector<W>&, std::vector<W>&, std::vector<W>&)      \
      const;                                                                                                           \
  template void Stepper<N>::accelerate(std::shared_ptr<const KernelPlan>);                                             \
  template void Stepper<N>::accelerate(std::shared_ptr<Kernel>, int);                                                  \
  template bool Stepper<N>::kernel_serves() const;                                                                     \
  template void Stepper<N>::load_kernel(const std::vector<W>&);                                                        \
  template void Stepper<N>::settle() const;                                                                            \
  template void Stepper<N>::settle_as_begun();                                                                         \
  template void Stepper<N>::settle_at_base();                                                                          \
  template void Stepper<N>::show_roots();                                                                              \
  template bool Stepper<N>::take_from_kernel();                                                                        \
  template double Stepper<N>::trusted_health() const;                                                                  \
  template const Expansion<Wider<N>>& Stepper<N>::point(bool) const;                                                   \
  template std::vector<Wider<N>> Stepper<N>::leading_at_base() const;                                                  \
  template std::optional<std::size_t> Stepper<N>::kernel_unknown(std::size_t) const;                                   \
  template StepperState<N>& Stepper<N>::settled(int) const;                                                            \
  template bool Stepper<N>::mapped() const;                                                                            \
  template void Stepper<N>::read(const W&, const std::vector<W>&, std::vector<W>&) const;                              \
  template void Stepper<N>::fetch_own_base(std::vector<W>&) const;                                                     \
  template void Stepper<N>::fetch_base(std::vector<W>&) const;
INSTANTIATE(double)
INSTANTIATE(long double)
INSTANTIATE(Quad)
INSTANTIATE(Multi)
#undef INSTANTIATE

}  // namespace anholon
