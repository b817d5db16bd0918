#include "integrate/step_end.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "integrate/series/hidden_points.h"
#include "integrate/series/time_kink.h"

namespace anholon {

namespace {

// A step ends past a kink by the tolerance and this many round-offs, so that the next step surely starts on the other
// side.
constexpr int kPastKink = 32;
// If the time alone decides, this many round-offs of it suffice, also in the wider numbers of the state.
constexpr int kPastTime = 4;
// After so many steps in a row that kinks cut shortly after their start, the motion stays at the kink.
constexpr int kMostShortKinks = 20;
// The motion goes back to a kink in a time that is a multiple of that by which it went past: the forces on both sides
// differ. It counts as short up to this multiple, and up to this part of the time between the kinks before.
constexpr double kMostTimes = 1e6, kMostPart = 1e-3, kLeastTimes = 4;

// A step of at most this many round-offs of the time is not shortened.
constexpr int kLeastRoundoffs = 64;

template <Number N>
Wider<N> least_step(const Wider<N>& t) {
  using W = Wider<N>;
  return convert<W>(unit_roundoff<N>()) * W(kLeastRoundoffs) * abs(t);
}

// Returns the largest length surely below h to which a step may be shortened. These lengths are the length without an
// end, halved repeatedly, so that steps do not depend on where a run stops.
template <Number W>
W shorter(W whole, const W& h) {
  constexpr double kSurely = 1 - 0x1p-20;  // h has been rounded with the time
  while (!(whole < abs(h) * W(kSurely))) whole = whole * W(0.5);
  return h > W(0) ? whole : W(-whole);
}

}  // namespace

template <Number N>
StepEnd<N>::StepEnd(const Program& program, double log_tolerance, int order)
    : program_(&program), log_tolerance_(log_tolerance), order_(order), check_(log_tolerance) {}

template <Number N>
void StepEnd<N>::set_slots(std::uint32_t end, std::vector<bool> others) {
  slots_ = end;
  others_.slots = std::move(others);
  others_.passed_over.clear();
  hiding_.clear();
  const Tape& tape = program_->tape;
  for (std::uint32_t s = 0; s < end; ++s)
    if (const auto hides = may_hide(tape, s)) hiding_.push_back(*hides);
}

template <Number N>
void StepEnd<N>::pass_over(const std::vector<std::uint32_t>& slots) {
  if (slots.empty() && others_.passed_over.empty()) return;
  others_.passed_over.assign(others_.slots.size(), false);
  for (const std::uint32_t slot : slots) others_.passed_over[slot] = true;
}

template <Number N>
void StepEnd<N>::restart() {
  others_.give_up = false;
  others_.shortened = 0;
  in_a_row_ = {};
  turns_ = {};
  at_kink_ = false;
  finish();
}

template <Number N>
void StepEnd<N>::finish() {
  limit_ = W(0);
  check_.forget();
}

// Returns the change that Newton's method would make to the leading derivatives at h beyond the expansion, relative to
// the size of the derivatives below them. It uses the LU at the start of the step, which does not lose more digits than
// the step itself.
template <Number N>
N StepEnd<N>::defect(PresentStep<N>& step, const W& h) {
  const Program& p = *program_;
  Expansion<N>& there = step.load(h);
  there.evaluate();
  there.equations(residual_);
  for (N& r : residual_) {
    if (!is_finite(r)) return r;
    r = -r;
  }
  step.series().system_jacobian().solve_once(residual_, change_);
  N worst(0);
  const int levels = *std::max_element(p.d.begin(), p.d.end());
  for (int d = 1; d <= levels; ++d) {
    N size(1), most(0);
    for (std::size_t j = 0; j < p.unknowns(); ++j) {
      if (p.d[j] < d) continue;
      if (const N x = abs(there.derivative(j, d - 1)); x > size) size = x;
      if (p.d[j] > d) continue;
      if (const N y = abs(change_[j]); !(y <= most)) most = y;
    }
    if (const N rate = most / size; !(rate <= worst)) worst = rate;
  }
  return worst;
}

// Finds the points within a step over h where a function may do something that its series do not show.
template <Number N>
void StepEnd<N>::find_hidden(PresentStep<N>& step, const W& h) {
  hidden_.points.clear();
  hidden_.known = true;
  const N length = convert<N>(h);
  if (const KernelExpansion* kernel = step.expander.kernel()) {
    std::vector<double> points;
    hidden_.known = kernel->add_hidden_points(slots_, to_double(length), points);
    for (const double x : points) hidden_.points.push_back(N(x));
  } else {
    const Machine<N>& machine = step.series().machine();
    for (const HidingSlot& hides : hiding_)
      if (!add_hidden_points(hides.function, machine.series(hides.argument), machine.series(hides.slot), order_ - 1,
                             length, hidden_.points))
        hidden_.known = false;
  }
  std::sort(hidden_.points.begin(), hidden_.points.end(), [](const N& a, const N& b) { return abs(a) < abs(b); });
}

// True if the equations hold at h beyond the expansion, and what is watched has the values of its series there.
template <Number N>
bool StepEnd<N>::may_end_at(PresentStep<N>& step, const EventWatch<N>& events, const W& h) {
  const N length = convert<N>(h);
  find_hidden(step, h);
  check_.begin(length, hidden_.points);
  if (!hidden_.known && check_.refuse() == EndCheck<N>::Next::shorten) return false;
  for (;;) {
    const bool decides = check_.decides();
    const N where = check_.where();
    auto next = check_.seen(defect(step, decides && where == length ? h : convert<W>(where)));
    if (decides && next != EndCheck<N>::Next::shorten && !as_foretold(step, events, where)) next = check_.refuse();
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

// True if what is watched has the values of its series there. REQUIRES: the formulas have been evaluated there.
template <Number N>
bool StepEnd<N>::as_foretold(PresentStep<N>& step, const EventWatch<N>& events, const N& where) const {
  return events.as_foretold(
      where, log_tolerance_, [&](std::size_t i) { return step.look.quadrature(i); },
      [&](std::size_t i) { return step.look.quadrature_made_of(i); });
}

// Like as_foretold(), at h beyond the expansion of a kernel, and where a watched formula may hide something before.
template <Number N>
bool StepEnd<N>::shows_events(PresentStep<N>& step, const EventWatch<N>& events, const W& h) {
  if (events.empty()) return true;
  const auto shows = [&](const W& where) {
    step.load_series(where);
    step.look.evaluate_watched();
    return as_foretold(step, events, convert<N>(where));
  };
  find_hidden(step, h);
  return std::all_of(hidden_.points.begin(), hidden_.points.end(),
                     [&](const N& where) { return shows(convert<W>(where)); }) &&
         shows(h);
}

// The time by which a step surely leads past a kink at `length` beyond t.
template <Number N>
Wider<N> StepEnd<N>::surely_past(const W& t, const W& length) const {
  return convert<W>(unit_roundoff<N>()) * W(kPastKink) * std::max(W(abs(t)), W(abs(length))) +
         W(std::exp(log_tolerance_)) * abs(length);
}

// Returns the time by which a step of length h ends past a kink. It is relative to the length up to the kink, or, if the
// motion meets the kink again, to that of the whole step.
template <Number N>
Wider<N> StepEnd<N>::past_kink(const Kink<N>& kink, const W& t, const W& where, const W& h) const {
  const W near = surely_past(t, where), roundoff = convert<W>(unit_roundoff<N>()) * W(kPastKink) * abs(h);
  const bool again = in_a_row_.met_again > 0 || !(abs(where) > std::max({near, roundoff, in_a_row_.past}) * W(4));
  return !kink.ahead || kink.at_start || again ? surely_past(t, h) : near;
}

template <Number N>
Outcome StepEnd<N>::shorten(PresentStep<N>& step, const EventWatch<N>& events, W& h, const W& whole) {
  const bool forward = h > W(0);
  const W asked = h, t = step.t(), last_step = step.track.now.record.last_step;
  KernelExpansion* kernel = step.expander.kernel();
  // A formula that is watched may have no series. Then a short step is made: after it the formula has series, or it has
  // none at all.
  constexpr double kShort = 0x1p-10, kAsShort = 0x1p-8;
  if (!events.empty() && (last_step == W(0) || last_step > abs(h) * W(kAsShort)) && events.without_series())
    h = shorter(whole, W(h * W(kShort)));
  Kink<N> kink;
  W where, past;
  // If no length that the time can show is good, because a formula loses its value ahead, the step is made: it ends the
  // motion with an outcome that names the formula.
  const W first = h, least = least_step<N>(t);
  for (bool refused = false;; h = shorter(whole, h)) {
    if (refused && !(abs(h) > least))
      h = first;
    else
      refused = false;
    // A kink at the end may be found shortly beyond it.
    const W reach = h + (forward ? surely_past(t, h) : W(-surely_past(t, h)));
    if (!kernel || kernel->may_turn())
      kink = first_kink<N>(step.series().machine(), slots_, order_ - 1, convert<N>(reach), !kernel,
                           others_.give_up ? others_.slots : others_.passed_over);
    where = kink.at_start ? W(0) : kink.ahead ? convert<W>(kink.where) : h;
    past = past_kink(kink, t, where, h);
    // Beyond a kink other functions hold.
    looked_ = kink.ahead ? W(where - (forward ? past : W(-past))) : where;
    if (!(abs(where) > past)) looked_ = W(0);
    if (refused || looked_ == W(0) ||
        (kernel ? shows_events(step, events, looked_) : may_end_at(step, events, looked_)))
      break;
    refused = true;
  }
  at_kink_ = kink.at_start || kink.ahead;
  if (at_kink_) note_passing(step.series().machine(), kink, forward);
  if (are_too_many(kink, where, past, whole)) {
    others_.give_up = true;
    h = asked;
    return shorten(step, events, h, whole);
  }
  in_a_row_.met_again = at_kink_ && !(abs(where) > past * W(4)) ? in_a_row_.met_again + 1 : 0;
  if (Outcome o = note_kink(kink.at_start, where, past); !o.ok() || !at_kink_) return o;
  const W to = beyond(step, events, kink, where, length_past(step, where, past, forward), forward);
  in_a_row_.past_before = std::exchange(in_a_row_.past, W(abs(W(to - where))));
  if (abs(to) < abs(h)) h = to, ++kinks_;
  return {};
}

// True if the motion would have to make many short steps, or end, because of kinks of what only watches it.
template <Number N>
bool StepEnd<N>::are_too_many(const Kink<N>& kink, const W& where, const W& past, const W& whole) {
  constexpr int kMost = 1000;
  constexpr double kMuchShorter = 0x1p-6;
  const auto of_others = [&](std::uint32_t slot) { return slot < others_.slots.size() && others_.slots[slot]; };
  const bool theirs = !others_.give_up &&
                      (kink.at_start ? std::all_of(kink.slots_at_start.begin(), kink.slots_at_start.end(), of_others)
                                     : kink.ahead && of_others(kink.argument));
  others_.shortened = theirs && abs(where) < whole * W(kMuchShorter) ? others_.shortened + 1 : 0;
  return others_.shortened > kMost ||
         (theirs && !kink.at_start && in_a_row_.short_kinks >= kMostShortKinks && is_short(where, past));
}

// Returns how far a step goes beyond a kink. A motion that begins at rest at a kink leaves it with the square of the
// time. After a step as short as `past`, the state does not yet resolve that it is past the kink, and the kink is met
// again. Then the steps grow as long as the equations hold at their ends.
template <Number N>
Wider<N> StepEnd<N>::length_past(PresentStep<N>& step, const W& where, const W& past, bool forward) {
  constexpr double kLonger = 4;
  if (!meets_again() || step.expander.kernel()) return past;
  const W longer = past * W(std::pow(kLonger, in_a_row_.met_again - 1)), h = where + (forward ? longer : W(-longer));
  const N length = convert<N>(h);
  return check_.passes_at_once(defect(step, h), length) ? longer : past;
}

// Returns the value that the deciding slot passes, in the wider numbers.
template <Number N>
static Wider<N> passed_exactly(const Kink<N>& kink) {
  if (kink.table)
    for (const Rational& knot : kink.table->knots)
      if (from_rational<N>(knot) == kink.passes) return from_rational<Wider<N>>(knot);
  return convert<Wider<N>>(kink.passes);
}

// A step ends at the time of a kink that the time alone decides. An event there is located where its formula has passed
// zero; in that case the step goes past the kink as past any other, and ends at the event.
template <Number N>
Wider<N> StepEnd<N>::beyond(PresentStep<N>& step, const EventWatch<N>& events, const Kink<N>& kink, const W& where,
                            const W& past, bool forward) const {
  const W usual = where + (forward ? past : W(-past));
  const W t = step.t(), roundoff = convert<W>(unit_roundoff<N>()) * W(kPastTime) * abs(t + where);
  const W least = forward ? roundoff : W(-roundoff);
  const auto time = [&](std::uint32_t slot, const W& value) {
    return passes_at<W>(*program_, step.expander.wide_parameters(), slot, value);
  };
  if (kink.at_start) {
    const bool alone = std::all_of(kink.slots_at_start.begin(), kink.slots_at_start.end(),
                                   [&](std::uint32_t slot) { return time(slot, W(0)).has_value(); });
    return alone && roundoff > W(0) ? least : usual;
  }
  if (!kink.slot) return usual;
  const auto exact = time(*kink.slot, passed_exactly(kink));
  if (!exact || abs(W(*exact - t - where)) > past) return usual;
  if (!events.empty() && events.may_pass_near(convert<N>(t), convert<N>(where), convert<N>(past))) return usual;
  const W to = *exact - t;
  if (!kink.enters || !has_exact_sign(*program_, *kink.slot) || !(abs(to) > roundoff))
    return roundoff > W(0) ? W(to + least) : usual;
  // The step ends at the exact time, or, if that is no number N, at the first number behind it.
  const bool short_of = forward ? convert<W>(convert<N>(*exact)) < *exact : convert<W>(convert<N>(*exact)) > *exact;
  return short_of ? W(to + least) : to;
}

// True if the motion meets a kink so soon that it may stay there.
template <Number N>
bool StepEnd<N>::is_short(const W& where, const W& past) const {
  // At kinks of constraints, pass_turn() decides.
  const double times =
      turns_.last ? kLeastTimes : std::clamp(kMostPart / std::exp(log_tolerance_), kLeastTimes, kMostTimes);
  return !(abs(where) >
           std::max(W(past * W(kLeastTimes)), W(std::max(in_a_row_.past, in_a_row_.past_before) * W(times))));
}

// At a kink, functions are taken one-sided along the motion: a very short step finds the side.
template <Number N>
Outcome StepEnd<N>::note_kink(bool at_start, const W& where, const W& past) {
  in_a_row_.short_kinks = at_kink_ && !at_start && is_short(where, past) ? in_a_row_.short_kinks + 1 : 0;
  if (!at_kink_) in_a_row_.past = in_a_row_.past_before = W(0);
  if (in_a_row_.short_kinks <= kMostShortKinks) return {};
  return {OutcomeKind::step_collapse, "the motion stays at the kink of an abs, sign, norm, piecewise or table",
          "a force that jumps there, as dry friction does, holds it: put a smooth function in its place, such "
          "as tanh(x/0.01) for sign(x)"};
}

template <Number N>
void StepEnd<N>::note_passing(const Machine<N>& machine, const Kink<N>& kink, bool forward) {
  turns_.forward = forward;
  turns_.passed.clear();
  for (const std::uint32_t slot : kink.slots_at_start)
    turns_.passed.push_back({slot, machine.series(slot)[0], machine.series(slot)[1]});
  if (!kink.ahead || !kink.slot) return;
  const N* c = machine.series(*kink.slot);
  N rate(0);
  for (int k = order_ - 1; k >= 1; --k) rate = rate * kink.where + c[k] * N(k);
  turns_.passed.push_back({*kink.slot, kink.passes, rate});
}

// True if a projection has put the state back to where it was before the kink.
template <Number N>
bool StepEnd<N>::put_back(const Machine<N>& machine) const {
  return std::any_of(turns_.passed.begin(), turns_.passed.end(), [&](const Passing& p) {
    const N past = machine.series(p.slot)[0] - p.value;
    return turns_.forward ? past * p.rate < N(0) : past * p.rate > N(0);
  });
}

template <Number N>
Outcome StepEnd<N>::stays_at_constraint(std::size_t equation) const {
  return {
      OutcomeKind::step_collapse,
      "the motion stays at a kink of the constraint '" + program_->system->equation_names[equation] +
          "': the velocities before the kink miss it after the kink, and no equation holds the impulse that changes "
          "them",
      "put a smooth function in its place, such as sqrt(x^2 + 0.01^2) for abs(x), or let an event with stop = true end "
      "the motion at the kink"};
}

// A projection onto a constraint that turns at a kink takes velocity away, like an impulse that is in no equation. The
// motion passes the kink if the deciding value goes on in its direction. At the kink itself the constraint has no
// slope.
template <Number N>
Outcome StepEnd<N>::pass_turn(const MissedConstraint<N>& missed, const Machine<N>& machine, const W& t, Outcome made) {
  constexpr double kStays = 1e-9, kSoon = 1e-9;
  constexpr int kMostSoon = 10, kMostPutBack = 3;
  if (!at_kink_ || made.kind == OutcomeKind::not_a_number) return made;
  turns_.put_back = missed.by > N(0) && put_back(machine) ? turns_.put_back + 1 : 0;
  if (turns_.put_back > kMostPutBack) return stays_at_constraint(missed.equation);
  if (!(missed.by > N(kTurned))) return made;
  const W since = turns_.last ? W(abs(W(t - *turns_.last))) : W(0);
  turns_.soon = turns_.last && since < turns_.longest * W(kSoon) ? turns_.soon + 1 : 0;
  turns_.longest = std::max(turns_.longest, since);
  turns_.last = t;
  const auto stays = [&](const Passing& p) {
    const N* now = machine.series(p.slot);
    return now[0] == p.value || !(now[1] * p.rate > N(kStays) * p.rate * p.rate);
  };
  const bool passes = turns_.soon < kMostSoon && std::none_of(turns_.passed.begin(), turns_.passed.end(), stays);
  return made.ok() && passes ? made : stays_at_constraint(missed.equation);
}

template <Number N>
void StepEnd<N>::set_free(const W& h) {
  looked_ = h;
  at_kink_ = false;
}

template <Number N>
void StepEnd<N>::set_one_sided() {
  in_a_row_.short_kinks = in_a_row_.met_again = 0;
  at_kink_ = true;
  ++kinks_;
}

template <Number N>
void StepEnd<N>::aim(PresentStep<N>& step, const W& t, bool arrives) {
  aimed_ = t;
  arrives_ = arrives;
  KernelExpansion* kernel = step.expander.kernel();
  if (!kernel) return;
  const W h = t - step.t();
  if (looked_ != W(0) && abs(h) < abs(looked_)) looked_ = h;
  if (looked_ == W(0)) {
    send(*kernel, step.t(), h);
    return;
  }
  find_hidden(step, looked_);
  check_.begin(convert<N>(looked_), hidden_.points);
  send(*kernel, step.t(), convert<W>(check_.where()));
}

// Sends the kernel to h beyond its expansion at t, to look at the equations there.
template <Number N>
LookAtEnd StepEnd<N>::send(KernelExpansion& kernel, const W& t, const W& h) {
  sent_ = h;
  const W to = h == aimed_ - t ? aimed_ : W(t + h);
  kernel.send(to_double(W(to - t)), to_double(to));
  return LookAtEnd::elsewhere;
}

// True if the velocities that the kernel gives where it was sent differ from those that its series foretell, which is
// impossible for a motion. It happens at a pole of a constraint, such as that of y' = x' tan(u) where cos(u) changes
// its sign: beyond it the quasi-velocities stand for the opposite velocities. A short step does not help.
template <Number N>
bool StepEnd<N>::velocities_jump(const KernelExpansion& kernel, const W& t, const N& horizon) const {
  if (!kernel.mapped() || !check_.may_jump(N(kernel.defect()), horizon)) return false;
  constexpr double kNone = 0x1p-10;
  const VelocityJump jump = kernel.velocity_jump(to_double(W(t + sent_)));
  return !(jump.most <= kNone * jump.speed) && check_.may_jump(N(jump.most / jump.size), horizon);
}

template <Number N>
LookAtEnd StepEnd<N>::look(KernelExpansion& kernel, const W& t, const N& horizon) {
  if (velocities_jump(kernel, t, horizon)) return LookAtEnd::by_reference;
  const W h = aimed_ - t;
  const N length = convert<N>(looked_);
  switch (looked_ == W(0) ? EndCheck<N>::Next::good
          : hidden_.known ? check_.seen(N(kernel.defect()))
                          : check_.refuse()) {
  case EndCheck<N>::Next::good:
    if (check_.loses_digits()) return LookAtEnd::by_reference;
    if (sent_ == h) return LookAtEnd::good;
    looked_ = W(0);
    return send(kernel, t, h);
  case EndCheck<N>::Next::look:
    return send(kernel, t, check_.where() == length ? looked_ : convert<W>(check_.where()));
  case EndCheck<N>::Next::shorten:
    break;
  }
  const W limit = abs(shorter(convert<W>(horizon), looked_));
  if (!(limit > least_step<N>(t))) {
    looked_ = W(0);
    return send(kernel, t, h);
  }
  limit_ = limit;
  return LookAtEnd::shorten;
}

template class StepEnd<double>;
template class StepEnd<long double>;
template class StepEnd<Quad>;
template class StepEnd<Multi>;

}  // namespace anholon
