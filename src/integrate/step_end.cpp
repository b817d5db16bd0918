// The part of the stepper that looks at the equations where a step is to end, and shortens it where they have become
// others.
#include <algorithm>
#include <cmath>

#include "integrate/kink.h"
#include "integrate/passed_over.h"
#include "integrate/taylor.h"
#include "kernel/kernel.h"

namespace anholon {

namespace {

// A step ends past a kink by the tolerance and this many round-offs, so that the next one starts surely on the other
// side.
constexpr int kPastKink = 32;
// Kinks met so soon after another one are other kinks, until they are too many.
constexpr int kMostShortKinks = 20;

// A step of so many round-offs of the time is none.
constexpr int kLeastRoundoffs = 64;

// Of the lengths that a step is shortened to, the largest surely below h: halves of what it would be without an end, so
// that steps do not depend on where a run is to stop.
template <Number W>
W shorter(W whole, const W& h) {
  constexpr double kSurely = 1 - 0x1p-20;  // h has been rounded with the time
  while (!(whole < abs(h) * W(kSurely))) whole = whole * W(0.5);
  return h > W(0) ? whole : W(-whole);
}

}  // namespace

// What Newton's method would change of the leading derivatives h beyond the expansion, in relation to the size of the
// derivatives below them; with the LU of where the step begins, which does not lose more digits than the step itself.
template <Number N>
N Stepper<N>::defect_at(const W& h) {
  const Program& p = *program_;
  std::vector<W> state, leading;
  on_polynomial(h, state, leading);
  Expansion<N>& there = loaded_ahead(t_ + h, state, leading);
  there.evaluate();
  there.equations(narrow_r_);
  for (N& r : narrow_r_) {
    if (!is_finite(r)) return r;
    r = -r;
  }
  expansion_.lu().solve_once(narrow_r_, narrow_y_);
  N worst(0);
  const int levels = *std::max_element(p.d.begin(), p.d.end());
  for (int d = 1; d <= levels; ++d) {
    N size(1), most(0);
    for (std::size_t j = 0; j < p.unknowns(); ++j) {
      if (p.d[j] < d) continue;
      if (const N x = abs(there.derivative(j, d - 1)); x > size) size = x;
      if (p.d[j] > d) continue;
      if (const N y = abs(narrow_y_[j]); !(y <= most)) most = y;
    }
    if (const N rate = most / size; !(rate <= worst)) worst = rate;
  }
  return worst;
}

template <Number N>
void Stepper<N>::find_hiding(std::uint32_t end) {
  hiding_.clear();
  const Tape& tape = program_->tape;
  for (std::uint32_t s = 0; s < end; ++s)
    if (const auto function = may_hide(tape, tape.code[s])) hiding_.push_back({s, *function});
}

// Points within a step over h where a function may do what its series do not show.
template <Number N>
void Stepper<N>::find_hidden(const W& h) {
  hidden_.clear();
  const N length = convert<N>(h);
  if (by_kernel_)
    find_hidden_by_kernel(length);
  else
    for (const auto& [slot, function] : hiding_) {
      const Machine<N>& machine = expansion_.machine();
      add_hidden(function, machine.series(hidden_argument(program_->tape.code[slot])), machine.series(slot), order_ - 1,
                 length, hidden_);
    }
  std::sort(hidden_.begin(), hidden_.end(), [](const N& a, const N& b) { return abs(a) < abs(b); });
}

// Whether the equations hold at h beyond the expansion, and what is watched has the values of its series.
template <Number N>
bool Stepper<N>::may_end_at(const W& h) {
  const N length = convert<N>(h);
  find_hidden(h);
  check_.begin(length, hidden_);
  for (;;) {
    const bool decides = check_.decides();
    const N where = check_.where();
    auto next = check_.seen(defect_at(decides && where == length ? h : convert<W>(where)));
    if (decides && next != EndCheck<N>::Next::shorten &&
        !events_.as_foretold(expansion_, order_ - 1, where, settings_.log_tolerance,
                             [this](std::size_t i) { return quadrature_there(i); }))
      next = check_.refuse();
    switch (next) {
    case EndCheck<N>::Next::good:
      return true;
    case EndCheck<N>::Next::look:
      break;
    case EndCheck<N>::Next::shorten:
      return false;
    }
  }
}

// Shortens a step over h to what the equations hold for, and to its first kink. `whole`: what it would be without an
// end.
template <Number N>
bool Stepper<N>::ends_as_foretold(W& h, const W& whole) {
  const bool forward = h > W(0);
  // Where a formula that is watched has no series, its values are looked at, in a short step: then it has some, or none
  // at all.
  constexpr double kShort = 0x1p-10, kAsShort = 0x1p-8;
  if (!events_.empty() && (record_.last_step == W(0) || record_.last_step > abs(h) * W(kAsShort)) &&
      events_.without_series(expansion_, order_ - 1))
    h = shorter(whole, W(h * W(kShort)));
  Kink<N> kink;
  W where, past;
  // Where no length serves that the time can show, as a formula loses its value ahead, the step is made: that is what
  // ends the motion, and has a name.
  const W first = h, least = convert<W>(unit_roundoff<N>()) * W(kLeastRoundoffs) * abs(t_);
  for (bool refused = false;; h = shorter(whole, h)) {
    if (refused && !(abs(h) > least))
      h = first;
    else
      refused = false;
    if (!by_kernel_ || may_touch_zero_)
      kink = first_kink<N>(expansion_.machine(), kinks_end(), order_ - 1, convert<N>(h));
    where = kink.at_start ? W(0) : kink.ahead ? convert<W>(kink.where) : h;
    past = convert<W>(unit_roundoff<N>()) * W(kPastKink) * (abs(t_) > abs(h) ? W(abs(t_)) : W(abs(h))) +
           W(std::exp(settings_.log_tolerance)) * abs(h);
    // Beyond a kink other functions hold.
    looked_ = kink.ahead ? W(where - (forward ? past : W(-past))) : where;
    if (!(abs(where) > past)) looked_ = W(0);
    if (refused || by_kernel_ || looked_ == W(0) || may_end_at(looked_)) break;
    refused = true;
  }
  at_kink_ = kink.at_start || kink.ahead;
  if (!at_kink_) {
    short_kinks_ = 0;
    return true;
  }
  // At a kink functions are taken one-sided along the motion: a very short step finds the side.
  short_kinks_ = !kink.at_start && !(abs(where) > past * W(4)) ? short_kinks_ + 1 : 0;
  if (short_kinks_ > kMostShortKinks)
    return fail({OutcomeKind::step_collapse, "the motion stays at the kink of an abs, sign, norm, piecewise or table",
                 "a force that jumps there, as dry friction does, holds it: put a smooth function in its place, such "
                 "as tanh(x/0.01) for sign(x)"});
  const W beyond = where + (forward ? past : W(-past));
  if (abs(beyond) < abs(h)) h = beyond, ++kinks_;
  return true;
}

// The kernel goes so far beyond its expansion, to look at the equations there.
template <Number N>
void Stepper<N>::send_kernel(const W& h) {
  sent_ = h;
  const W t = h == aimed_ - t_ ? aimed_ : W(t_ + h);
  kernel_->set_step(lane_, to_double(W(t - t_)));
  kernel_->set_time(lane_, to_double(t));
}

// The kernel is where it was sent.
template <Number N>
EndOfStep Stepper<N>::looks_at_end(const W& end) {
  if (!by_kernel_) return EndOfStep::good;
  const W h = aimed_ - t_;
  const N length = convert<N>(looked_);
  switch (looked_ == W(0) ? EndCheck<N>::Next::good : check_.seen(defect_by_kernel())) {
  case EndCheck<N>::Next::good:
    if (sent_ == h) return EndOfStep::good;
    looked_ = W(0);
    send_kernel(h);
    return EndOfStep::elsewhere;
  case EndCheck<N>::Next::look:
    send_kernel(check_.where() == length ? looked_ : convert<W>(check_.where()));
    return EndOfStep::elsewhere;
  case EndCheck<N>::Next::shorten:
    break;
  }
  const W limit = abs(shorter(convert<W>(horizon_), looked_));
  if (!(limit > convert<W>(unit_roundoff<N>()) * W(kLeastRoundoffs) * abs(t_))) {
    looked_ = W(0);
    send_kernel(h);
    return EndOfStep::elsewhere;
  }
  limit_ = limit;
  singular_ahead_ = false;
  kinks_ = kinks_before_;
  kernel_->show_advanced(false);
  const bool good = aims(end);
  if (!good) settle();
  kernel_->show_advanced(true);
  return good ? EndOfStep::elsewhere : EndOfStep::failed;
}

#define INSTANTIATE(N)                                                                                                 \
  template N Stepper<N>::defect_at(const W&);                                                                          \
  template bool Stepper<N>::may_end_at(const W&);                                                                      \
  template void Stepper<N>::find_hiding(std::uint32_t);                                                                \
  template void Stepper<N>::find_hidden(const W&);                                                                     \
  template bool Stepper<N>::ends_as_foretold(W&, const W&);                                                            \
  template void Stepper<N>::send_kernel(const W&);                                                                     \
  template EndOfStep Stepper<N>::looks_at_end(const W&);
INSTANTIATE(double)
INSTANTIATE(long double)
INSTANTIATE(Quad)
INSTANTIATE(Multi)
#undef INSTANTIATE

}  // namespace anholon
