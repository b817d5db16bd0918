// Decides where a step of the stepper ends.
#include <cmath>
#include <concepts>
#include <limits>

#include "base/assert.h"
#include "integrate/step_budget.h"
#include "integrate/stepper.h"

namespace anholon {

template <Number N>
bool Stepper<N>::aim(const W& end) {
  ordinary_ = aim_ordinarily(end);
  if (!ordinary_) {
    if (phase_ == Phase::begun && !end_expansion()) return false;
    ANHOLON_ASSERT(phase_ == Phase::expanded);
    if (!aim_freely(end) && !aim_with_care(end)) return false;
  }
  phase_ = Phase::aimed;
  return true;
}

// Judges the step after the kernel has gone where it was sent.
template <Number N>
EndOfStep Stepper<N>::look_at_end(const W& end) {
  ANHOLON_ASSERT(phase_ == Phase::aimed);
  KernelExpansion* kernel = expander_.kernel();
  if (!kernel) return EndOfStep::good;
  if (ordinary_) {
    if (end_.passes_at_once(N(kernel->defect()), convert<N>(W(ordinary_end_ - time()))) && !kernel->blows_up())
      return EndOfStep::good;
    ordinary_ = false;
    aim_at(ordinary_end_);
  }
  switch (end_.look(*kernel, time(), horizon_)) {
  case LookAtEnd::good:
    return EndOfStep::good;
  case LookAtEnd::elsewhere:
    return EndOfStep::elsewhere;
  case LookAtEnd::shorten:
    return aim_again(*kernel, end) ? EndOfStep::elsewhere : EndOfStep::failed;
  case LookAtEnd::by_reference:
    break;
  }
  return aim_by_reference(*kernel, end) ? EndOfStep::good : EndOfStep::failed;
}

// Takes back what was chosen for the step that is aimed.
template <Number N>
void Stepper<N>::drop_aim() {
  guard_.set_singular_ahead(false);
  end_.again();
  events_.take_back();
  phase_ = Phase::expanded;
}

template <Number N>
bool Stepper<N>::aim_again(KernelExpansion& kernel, const W& end) {
  drop_aim();
  kernel.show_advanced(false);
  const bool good = aim(end);
  if (!good) leave_kernel();
  kernel.show_advanced(true);
  return good;
}

// Makes the reference repeat the expansion of the step that is aimed, in place of the kernel.
template <Number N>
bool Stepper<N>::aim_by_reference(KernelExpansion& kernel, const W& end) {
  drop_aim();
  kernel.show_advanced(false);
  expander_.refuse_kernel(track_);
  kernel.show_advanced(true);
  ++expansions_;
  if (Outcome o = expand_by_reference(track_.now.leading); !o.ok()) {
    phase_ = Phase::placed;
    return fail(std::move(o));
  }
  return aim(end);
}

template <Number N>
bool Stepper<N>::may_be_ordinary() const
  requires std::same_as<N, double>
{
  return phase_ == Phase::begun && settings_.ordinary_steps && expander_.goes_on_with_kernel() &&
         !guard_.singular_ahead() && end_.idle() && fired_.empty() && events_.empty();
}

// Aims an ordinary step after one of the same kernel, as most steps are: neither the expansion, nor the way to where
// its series reach, nor (look_at_end) the equations there need a closer look. If one does, the other functions take
// over from there.
template <Number N>
bool Stepper<N>::aim_ordinarily(const W& end) {
  if constexpr (std::same_as<N, double>) {
    if (!may_be_ordinary() || !expander_.end_at_once(track_)) return false;
    ++expansions_;
    phase_ = Phase::expanded;
    KernelExpansion& kernel = *expander_.kernel();
    horizon_ = kernel.reach();
    limit_by_quadratures();
    const W left = end - time();
    if (!(horizon_ > std::abs(to_double(time())) * kShortStep) || !(horizon_ < abs(left)) ||
        out_of_reach(horizon_, left))
      return false;
    ordinary_end_ = static_cast<double>(left > 0 ? time() + horizon_ : time() - horizon_);
    const double length = to_double(W(ordinary_end_ - time()));
    if (!kernel.hides_nothing_over(length)) return false;
    kernel.send(length, to_double(ordinary_end_));
    return true;
  } else {
    (void)end;
    return false;
  }
}

// Aims a step of a kernel, of the length that the series allow. Returns false if something may be in the way.
template <Number N>
bool Stepper<N>::aim_freely(const W& end) {
  const KernelExpansion* kernel = expander_.kernel();
  if (!kernel || kernel->suspected() || guard_.singular_ahead() || kernel->may_turn() || !end_.free_of_kinks() ||
      !fired_.empty() || !events_.empty() || !(to_double(horizon()) > std::abs(to_double(time())) * kShortStep))
    return false;
  const W left = end - time(), h = horizon();
  if (!(h < abs(left)) || out_of_reach(h, left)) return false;
  aim_at(convert<W>(convert<N>(W(left > W(0) ? time() + h : time() - h))));
  return true;
}

template <Number N>
void Stepper<N>::aim_at(const W& to) {
  end_.set_free(to - time());
  PresentStep<N> step = present();
  end_.aim(step, to, false);
}

// Returns the nearest number with one binary digit less; other types of numbers are left unchanged.
template <Number N>
static N with_one_digit_less(const N& x) {
  if constexpr (std::floating_point<N>) {
    int exponent = 0;
    std::frexp(x, &exponent);
    const int last = exponent - std::numeric_limits<N>::digits + 1;
    return std::ldexp(std::nearbyint(std::ldexp(x, -last)), last);
  } else {
    return x;
  }
}

template <Number N>
bool Stepper<N>::aim_with_care(const W& end) {
  const W left = end - time();
  const bool forward = left > W(0);
  if (one_sided_) return aim_one_sided(left);
  PresentStep<N> step = present();
  W h = horizon();
  // The length does not depend on what is left to the end: a run that continues from here must make the same steps as
  // one that was not stopped.
  if (program_->several_solutions) h = abs(guard_.on_the_branch(step, forward ? h : W(-h), record()));
  const W floor = convert<W>(unit_roundoff<N>()) * W(kCollapsedRoundoffs) * abs(time());
  if (!(h > floor))
    return fail({OutcomeKind::step_collapse, "the step size fell below what the time can resolve",
                 "the motion approaches a singularity: stop before it, or look at the last good state"});
  if (out_of_reach(h, left)) return fail(end_out_of_reach(settings_, to_double(h)));
  if (guard_.singular_ahead()) return fail(becomes_singular());
  const W whole = h;
  if (!(h < abs(left))) h = abs(left);
  if (!forward) h = -h;
  if (Outcome o = end_.shorten(step, events_, h, whole); !o.ok()) return fail(std::move(o));
  if (end_.meets_again()) record().careful = true;
  if (!shorten_at_singular_point(h, floor)) return fail(becomes_singular());
  shorten_at_event(h, end_.kink());
  // The end of the step is a number that t can show exactly: otherwise the time loses a round-off at every step.
  if (h == left) {
    end_.aim(step, end, true);
  } else {
    const N to = convert<N>(W(time() + h));
    end_.aim(step, convert<W>(settings_.coarse_times && !fired_.empty() ? with_one_digit_less(to) : to), false);
  }
  return true;
}

// Shortens the step to where J is still regular. Returns false if that is shorter than the floor.
template <Number N>
bool Stepper<N>::shorten_at_singular_point(W& h, const W& floor) {
  constexpr double kShortOf = 1 - 1e-7;
  if (expander_.kernel() && !expander_.suspected() && !JacobianGuard<N>::longer_than(h, record().last_step))
    return true;
  leave_kernel();
  PresentStep<N> step = present();
  const std::optional<W> met = guard_.singular_within(step, h, record().last_step);
  if (!met) return true;
  h = *met * W(kShortOf);
  guard_.set_singular_ahead(true);
  return abs(h) > floor;
}

template <Number N>
void Stepper<N>::shorten_at_event(W& h, const std::optional<N>& kink) {
  fired_.clear();
  if (events_.empty()) return;
  N to = convert<N>(h);
  const N length = to;
  PresentStep<N> step = present();
  fired_ = events_.look(convert<N>(time()), to, kink,
                        [&](std::size_t i, const N& where) { return step.quadrature(i, where); });
  if (to == length) return;
  h = convert<W>(to);
  guard_.set_singular_ahead(false);
}

template <Number N>
bool Stepper<N>::aim_one_sided(const W& left) {
  PresentStep<N> step = present();
  W h = convert<W>(horizon_);
  if (!(h < abs(left))) h = abs(left);
  if (left < W(0)) h = -h;
  if (!take_one_sided(h)) return fail(one_sided_->stop(step, h));
  guard_.set_singular_ahead(false);
  end_.set_one_sided();
  if (!events_.empty()) h = convert<W>(convert<N>(h));
  read_events();
  shorten_at_event(h, std::nullopt);
  const bool last = !(abs(h) < abs(left));
  end_.aim(step, last ? W(time() + left) : convert<W>(convert<N>(W(time() + h))), last);
  return true;
}

template <Number N>
bool Stepper<N>::out_of_reach(const W& h, const W& left) {
  return paces_.out_of_reach(settings_, record().steps, to_double(time()), to_double(h), to_double(left));
}

template <Number N>
std::optional<OrdinaryCourse> Stepper<N>::ordinary_course() const
  requires std::same_as<N, double>
{
  const double t = to_double(time());
  if (!may_be_ordinary() || settings_.measure || !integrals().empty() || W(t) != time()) return std::nullopt;
  OrdinaryCourse c;
  c.last.to = t;
  c.pivots = expander_.kernel()->last_pivots();
  c.least_health = expander_.kernel()->least_health();
  c.most = std::min(settings_.most_steps - record().steps, paces_.steps_unjudged(record().steps));
  c.most_ahead = settings_.most_steps - record().steps - c.most;
  return c;
}

template <Number N>
void Stepper<N>::follow(const OrdinaryCourse& course)
  requires std::same_as<N, double>
{
  ANHOLON_ASSERT(may_be_ordinary());
  if (course.steps > 0) {
    before_ = course.steps > 1 ? W(course.before.to) : time();
    record().sigma_before = guard_.sigma();
  }
  expansions_ += course.steps;
  expander_.follow(track_, course);
  if (!course.aimed) return;
  ++expansions_;
  horizon_ = course.horizon;
  ordinary_ = true;
  ordinary_end_ = course.end;
  phase_ = Phase::aimed;
}

#define INSTANTIATE(N)                                                                                                 \
  template bool Stepper<N>::aim(const Wider<N>&);                                                                      \
  template EndOfStep Stepper<N>::look_at_end(const Wider<N>&);                                                         \
  template void Stepper<N>::drop_aim();                                                                                \
  template bool Stepper<N>::aim_again(KernelExpansion&, const Wider<N>&);                                              \
  template bool Stepper<N>::aim_by_reference(KernelExpansion&, const Wider<N>&);                                       \
  template bool Stepper<N>::aim_ordinarily(const Wider<N>&);                                                           \
  template bool Stepper<N>::aim_freely(const Wider<N>&);                                                               \
  template void Stepper<N>::aim_at(const Wider<N>&);                                                                   \
  template bool Stepper<N>::aim_with_care(const Wider<N>&);                                                            \
  template bool Stepper<N>::aim_one_sided(const Wider<N>&);                                                            \
  template bool Stepper<N>::shorten_at_singular_point(Wider<N>&, const Wider<N>&);                                     \
  template void Stepper<N>::shorten_at_event(Wider<N>&, const std::optional<N>&);                                      \
  template bool Stepper<N>::out_of_reach(const Wider<N>&, const Wider<N>&);
template std::optional<OrdinaryCourse> Stepper<double>::ordinary_course() const;
template void Stepper<double>::follow(const OrdinaryCourse&);
template bool Stepper<double>::may_be_ordinary() const;
INSTANTIATE(double)
INSTANTIATE(long double)
INSTANTIATE(Quad)
INSTANTIATE(Multi)
#undef INSTANTIATE

}  // namespace anholon
