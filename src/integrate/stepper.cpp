#include "integrate/stepper.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/assert.h"
#include "integrate/series/kinks.h"
#include "integrate/step_budget.h"
#include "numeric/told_time.h"

namespace anholon {

template <Number N>
Stepper<N>::Stepper(const Program& program, const std::vector<N>& parameters, const std::vector<W>& wide_parameters,
                    const StepSettings& settings)
    : program_(&program), settings_(settings),
      order_(settings.order > 0 ? settings.order : taylor_order(settings.log_tolerance)),
      tolerance_(settings.log_tolerance), expander_(program, parameters, wide_parameters, settings, order_),
      look_(program, parameters), guard_(program), end_(program, settings.log_tolerance, order_) {
  watch_kinks();
}

// ---- one step -------------------------------------------------------------------------------------------------------

template <Number N>
bool Stepper<N>::make_step(const W& end) {
  if (!begin_step()) return false;
  expander_.expand_kernel();
  if (!aim(end)) return false;
  if (KernelExpansion* kernel = expander_.kernel()) {
    EndOfStep there = EndOfStep::elsewhere;
    while (there == EndOfStep::elsewhere) {
      kernel->advance();
      there = look_at_end(end);
    }
    if (there == EndOfStep::failed) return false;
  }
  if (!finish_step()) return false;
  if (arrived()) leave_kernel();
  return true;
}

template <Number N>
Outcome Stepper<N>::steps(const W& end, Stretch<W>& stretch) {
  const std::size_t kinks = end_.kinks();
  const bool forward = end > time();
  for (;;) {
    if (!make_step(end)) return trouble();
    stretch.times.push_back(time());
    if (stretch.times.size() >= stretch.most || time() == end || !fired_.empty() || end_.kinks() != kinks ||
        (stretch.until && (forward ? !(time() < *stretch.until) : !(time() > *stretch.until))) || !stays(stretch))
      return {};
    if (!integrals().empty())
      if (const W size = abs(integrals()[0]); size > stretch.greatest_integral) stretch.greatest_integral = size;
    round_state();
  }
}

// True if the last step began where the unknowns have nearly the values that the caller knows.
template <Number N>
bool Stepper<N>::stays(const Stretch<W>& stretch) const {
  for (const auto& [unknown, value] : stretch.kept)
    if (!(std::abs(to_double(expander_.coefficient(unknown, 0)) - value) < stretch.margin)) return false;
  return true;
}

template <Number N>
bool Stepper<N>::begin_step() {
  if (const bool cancelled = settings_.cancelled && settings_.cancelled();
      cancelled || record().steps >= settings_.most_steps)
    return fail(interrupted(cancelled));
  if (phase_ != Phase::expanded) begin_expansion();
  end_.begin();
  return true;
}

template <Number N>
bool Stepper<N>::finish_step() {
  ANHOLON_ASSERT(phase_ == Phase::aimed);
  if (ordinary_) {
    finish_at(ordinary_end_);
    return true;
  }
  if (!expander_.advance(track_, end_.time() - time())) {
    note_length(end_.time());
    return fail({OutcomeKind::blow_up, "the motion grows without bound",
                 "look at the last good state: a velocity or position diverges"});
  }
  finish_at(end_.time());
  end_.finish();
  return true;
}

template <Number N>
void Stepper<N>::note_length(const W& to) {
  record().last_step = abs(W(to - time()));
  record().sigma_before = guard_.sigma();
}

// Ends the step: the state is there already.
template <Number N>
void Stepper<N>::finish_at(const W& to) {
  MotionState<N>& m = track_.now;
  note_length(to);
  const W h = to - m.t;
  for (std::size_t i = 0; i < m.integrals.size(); ++i)
    add_compensated(m.integrals[i], m.integral_carry[i], expander_.integral(i, h));
  before_ = m.t;
  m.t = to;
  phase_ = Phase::advanced;
  ++m.record.steps;
}

// If the next expansion is already made, its polynomial remains, not that of the last step.
template <Number N>
bool Stepper<N>::fail(Outcome why) {
  if (expanded()) {
    before_ = time();
    phase_ = Phase::expanded;
  }
  trouble_ = std::move(why);
  return false;
}

// A followed quadrature makes a step shorter than the motion's by this part at most.
static constexpr double kShortestFollowed = 0x1p-6;

// ---- the expansion --------------------------------------------------------------------------------------------------

template <Number N>
void Stepper<N>::begin_expansion() {
  ANHOLON_ASSERT(phase_ == Phase::placed || phase_ == Phase::advanced);
  expander_.begin(track_, track_.now.leading, false);
  track_.begun().at.sides = events_.sides();
  phase_ = Phase::begun;
}

template <Number N>
bool Stepper<N>::end_expansion() {
  ANHOLON_ASSERT(phase_ == Phase::begun);
  const bool first = expansions_++ == 0;
  Outcome o = end_by_kernel() ? Outcome{} : expand_by_reference(track_.now.leading);
  if (o.ok() && expander_.suspected())
    o = look_back();
  else if (!o.ok() && !first)
    expand_again(StepperState<N>(track_.previous().at));
  if (o.ok()) return true;
  phase_ = Phase::placed;
  return fail(std::move(o));
}

template <Number N>
bool Stepper<N>::end_by_kernel() {
  if (!expander_.end_by_kernel(track_)) return false;
  if (end_.at_kink() &&
      expander_.drift_of_kernel() > StepEnd<N>::kTurned) {  // the reference tells whether the motion passes the kink
    expander_.refuse_kernel(track_);
    return false;
  }
  one_sided_.reset();
  read_events();
  if (!events_.have_series()) {
    expander_.refuse_kernel(track_);
    return false;
  }
  horizon_ = expander_.reach();
  limit_by_kinks();
  limit_by_events();
  limit_by_quadratures();
  expander_.look_for_turns(horizon_);
  phase_ = Phase::expanded;
  return true;
}

template <Number N>
Outcome Stepper<N>::expand_by_reference(const std::vector<W>& guess) {
  one_sided_.reset();
  Outcome o = expand_regularly(guess);
  return o.kind == OutcomeKind::not_a_number ? expand_one_sided(std::move(o)) : o;
}

template <Number N>
Outcome Stepper<N>::expand_regularly(const std::vector<W>& guess) {
  if (Outcome o = expander_.prepare(track_, guess); !o.ok()) return o;
  if (Outcome o = guard_.check(expander_.series(), time(), record()); !o.ok()) return o;
  Outcome made = expander_.solve(track_, guess);
  if (made.ok()) made = expander_.extend();
  made = end_.pass_turn(expander_.missed(), expander_.series().machine(), time(), std::move(made));
  if (!made.ok()) return made;
  horizon_ = expander_.reach();
  limit_by_kinks();
  read_events();
  limit_by_events();
  limit_by_quadratures();
  phase_ = Phase::expanded;
  return {};
}

// If a kernel has made the expansion, the formulas are evaluated at its point for the magnitude of their terms.
template <Number N>
void Stepper<N>::read_events() {
  if (events_.empty()) return;
  const auto coefficient = [&](std::size_t i, int k) { return expander_.quadrature(i, k); };
  if (expander_.kernel()) {
    present().load_series(W(0));
    look_.evaluate_watched();
    events_.read(order_ - 1, coefficient, [&](std::size_t i) { return look_.quadrature_terms(i); });
  } else {
    events_.read(order_ - 1, coefficient, [&](std::size_t i) { return expander_.series().quadrature_terms(i); });
  }
  if (record().steps == 0) events_.begin_at_zero();
}

// The values that decide which functions hold may change faster than the motion. If a kernel has made the expansion,
// formulas are evaluated for the magnitude of their terms.
template <Number N>
void Stepper<N>::limit_by_kinks() {
  expander_.show_deciding();
  if (kink_arguments_.empty()) return;
  const Machine<N>& series = expander_.series().machine();
  const Machine<N>* values = &series;
  if (expander_.kernel()) {
    values = &present().load_series(W(0)).machine();
    look_.evaluate_kinks();
  }
  std::vector<std::uint32_t> needed, others, quiet;
  for (const std::uint32_t slot : kink_arguments_)
    (!end_.others()[slot]                                           ? needed
     : is_round_off<N>(slot, series, *values, order_ - 1, horizon_) ? quiet
                                                                    : others)
        .push_back(slot);
  end_.pass_over(quiet);
  const auto known = [&](const std::vector<std::uint32_t>& slots) {
    return N(std::exp(kinks_log_reach<N>(slots, series, *values, order_ - 1, settings_.log_tolerance)));
  };
  if (const N all = known(needed); all < horizon_) horizon_ = all;
  if (others.empty()) return;
  // Like followed quadratures, these slots do not make a step much shorter.
  const N shortest = horizon_ * N(kShortestFollowed);
  if (const N all = known(others); all < horizon_) horizon_ = all > shortest ? all : shortest;
}

// A watched formula may change faster than the motion, on which it has no influence: the density of thin air.
template <Number N>
void Stepper<N>::limit_by_events() {
  if (const N known(std::exp(events_.log_reach(settings_.log_tolerance))); known < horizon_) horizon_ = known;
}

template <Number N>
std::optional<std::size_t> Stepper<N>::shortened_by() const {
  constexpr double kMuchFarther = 1e3;
  if (events_.empty() || phase_ != Phase::expanded) return std::nullopt;
  const N known(std::exp(events_.log_reach(settings_.log_tolerance)));
  if (known > horizon_ || !(expander_.reach() > known * N(kMuchFarther))) return std::nullopt;
  return events_.least_known(settings_.log_tolerance);
}

template <Number N>
void Stepper<N>::limit_by_quadratures() {
  if constexpr (std::same_as<N, double>)
    if (const KernelExpansion* kernel = expander_.kernel()) return limit_by_quadratures(*kernel);
  limit_by_quadratures(expander_);
}

// `series` has the quadratures of the present expansion.
template <Number N>
template <class Series>
void Stepper<N>::limit_by_quadratures(const Series& series) {
  const std::vector<W>& integrals = track_.now.integrals;
  for (std::size_t i = 0; i < std::min(settings_.integrals, integrals.size()); ++i)
    if (!series.constant_quadrature(i))
      horizon_ = limited_by_quadrature(horizon_, order_, tolerance_, to_double(integrals[i]),
                                       [&](int k) -> N { return series.quadrature(i, k); });
  for (std::size_t i = settings_.known_from; i < std::min(settings_.known_to, program_->quadratures); ++i)
    if (!series.constant_quadrature(i))
      horizon_ = limited_by_value(horizon_, order_, tolerance_, [&](int k) -> N { return series.quadrature(i, k); });
  // Near a point where a formula has no series, the series do not converge, however short the step is.
  const N shortest = horizon_ * N(kShortestFollowed);
  for (std::size_t i = settings_.known_to; i < std::min(settings_.followed_to, program_->quadratures); ++i)
    if (!series.constant_quadrature(i))
      horizon_ = limited_by_value(horizon_, order_, tolerance_, [&](int k) -> N { return series.quadrature(i, k); });
  if (!(horizon_ > shortest)) horizon_ = shortest;
}

// If there is no such step in either direction of time, the fault is returned.
template <Number N>
Outcome Stepper<N>::expand_one_sided(Outcome fault) {
  const std::vector<W>& state = track_.now.state;
  if (!std::all_of(state.begin(), state.end(), [](const W& x) { return is_finite(x); })) return fault;
  PresentStep<N> step = present();
  one_sided_.emplace(step, std::move(fault));
  const W h = OneSidedStart<N>::length(step, point(), settings_.log_tolerance);
  if (!take_one_sided(h) && !take_one_sided(-h)) {
    Outcome o = one_sided_->fault(step, h);
    one_sided_.reset();
    return o;
  }
  horizon_ = convert<N>(h);
  phase_ = Phase::expanded;
  return {};
}

template <Number N>
bool Stepper<N>::take_one_sided(const W& h) {
  PresentStep<N> step = present();
  auto leading = one_sided_->take(step, h);
  if (leading) track_.now.leading = *std::move(leading);
  return leading.has_value();
}

// Makes an expansion outside of a step.
template <Number N>
Outcome Stepper<N>::expand() {
  phase_ = Phase::placed;
  if (!expander_.alone()) record().careful = true;  // so that the other lanes of the kernel are not expanded
  begin_expansion();
  expander_.expand_kernel();
  return end_expansion() ? Outcome{} : trouble();
}

// Makes an expansion in place of the present one.
template <Number N>
Outcome Stepper<N>::expand_here(const std::vector<W>& guess) {
  expander_.begin(track_, guess, true);
  ++expansions_;
  expander_.expand_kernel();
  return end_by_kernel() ? Outcome{} : expand_by_reference(guess);
}

// After a failure, makes the expansion of the last good step again, because callers still need its polynomial.
template <Number N>
void Stepper<N>::expand_again(const StepperState<N>& last) {
  MotionState<N> now = track_.now;
  track_.now = last.motion;
  track_.now.integrals = now.integrals;
  track_.now.integral_carry = now.integral_carry;
  track_.now.record = now.record;
  before_ = last.motion.t;
  expand_here(last.motion.leading);
  leave_kernel();
  track_.begun().at = last;
  now.record = record();
  now.carry.resize(now.state.size(), W(0));
  track_.now = std::move(now);
  phase_ = Phase::placed;
}

// Asks the reference whether J was singular within the last step, at both ends first.
template <Number N>
Outcome Stepper<N>::look_back() {
  leave_kernel();
  if (guard_.regular_between(look_, track_.previous().at.motion, track_.now)) return {};
  const StepperState<N> now = track_.begun().at, last = track_.previous().at;
  record().careful = true;
  expand_again(last);
  PresentStep<N> step = present();
  const std::optional<W> met = guard_.singular_within(step, now.motion.t - last.motion.t, W(0));
  if (met) {
    Outcome o = becomes_singular();
    tell_time(o, to_double(W(last.motion.t + *met)));
    return o;
  }
  record().careful = true;
  const Outcome o = expand_here(now.motion.leading);
  track_.begun().at = now;
  track_.previous().at = last;
  return o;
}

// ---- where it starts ------------------------------------------------------------------------------------------------

template <Number N>
void Stepper<N>::place(const W& t, const std::vector<W>& state, const std::vector<W>& leading) {
  track_ = {motion_from<N>(t, state, leading, program_->quadratures), {}, 0};
  before_ = t;
  paces_.begin(to_double(t), 0);
  phase_ = Phase::placed;
  expansions_ = 0;
  expander_.reset();
  expander_.forget_direction();
  guard_.restart();
  end_.restart();
  events_.restart();
  fired_.clear();
}

template <Number N>
Outcome Stepper<N>::start(const W& t, const std::vector<W>& state, const std::vector<W>& leading, bool kernel) {
  place(t, state, leading);
  record().careful = !kernel;
  return expand();
}

template <Number N>
void Stepper<N>::adopt(const Stepper& other) {
  track_.now = other.motion();
  track_.now.own.clear();
  record() = with_other_equations(other.record());
  paces_ = other.paces_;
  before_ = time();
  events_ = other.events_;
  phase_ = Phase::placed;
  expander_.restart();
  end_.finish();
}

template <Number N>
Outcome Stepper<N>::take_over(const Stepper& other) {
  adopt(other);
  return expand();
}

template <Number N>
Outcome Stepper<N>::restart(const std::vector<W>& state, bool kernel) {
  leave_kernel();
  if (!kernel) record().careful = true;
  before_ = time();  // the last step's polynomial does not belong to this state
  track_.now.state = state;
  track_.now.carry.assign(state.size(), W(0));
  track_.now.own.clear();
  events_.restart();
  fired_.clear();
  end_.restart();
  // The correction of values set by an event is not drift from the constraints.
  const W drift = record().worst_constraint;
  Outcome o = expand();
  record().worst_constraint = drift;
  return o;
}

template <Number N>
Outcome Stepper<N>::resume(const StepperState<N>& begun) {
  track_.now = begun.motion;
  before_ = time();
  paces_.begin(to_double(time()), record().steps);
  expander_.restart();
  expander_.series().set_weakest_direction(begun.direction);
  guard_.set_sigma(record().sigma_before);
  if (!begun.sides.empty()) events_.set_sides(begun.sides);
  end_.finish();
  return expand();
}

template <Number N>
void Stepper<N>::accelerate(std::shared_ptr<const KernelPlan> plan)
  requires std::same_as<N, double>
{
  if (!plan) return;
  auto kernel = std::make_shared<Kernel>(std::move(plan));
  kernel->set_parameters(0, expander_.wide_parameters(),
                         settings_.other_rounding ? Rounding::other : Rounding::nearest);
  accelerate(std::move(kernel), 0);
}

template <Number N>
void Stepper<N>::accelerate(std::shared_ptr<Kernel> kernel, int lane)
  requires std::same_as<N, double>
{
  leave_kernel();
  track_.now.own.clear();
  expander_.accelerate(KernelExpansion(std::move(kernel), lane, *program_, order_, settings_.log_tolerance));
}

// Formulas that are watched, or have to be known over each step, may have kinks, too.
template <Number N>
void Stepper<N>::watch_kinks() {
  const bool equations_alone =
      events_.empty() && settings_.known_from >= std::max(settings_.known_to, settings_.followed_to);
  const std::size_t end = equations_alone ? program_->tape.main_end : program_->tape.code.size();
  // A followed quadrature shortens steps, but neither changes the motion nor ends it.
  std::vector<std::uint32_t> needed;
  for (std::size_t i = 0; i < std::min(settings_.known_to, program_->quadratures); ++i)
    needed.push_back(program_->tape.roots[program_->unknowns() + i]);
  for (const WatchedSeries& s : events_.series())
    needed.push_back(program_->tape.roots[program_->unknowns() + s.quadrature]);
  needed = precedents(program_->tape, needed);
  for (std::uint32_t slot = 0; slot < program_->tape.main_end; ++slot) needed.push_back(slot);
  const auto slots = static_cast<std::uint32_t>(end);
  end_.set_slots(slots, deciding_for_others(program_->tape, slots, needed));
  kink_arguments_ = kink_arguments(program_->tape, end_.slots());
  look_.watch_kinks(kink_arguments_);
}

template <Number N>
void Stepper<N>::watch(std::vector<WatchedSeries> series) {
  std::vector<std::size_t> quadratures;
  for (const WatchedSeries& s : series) quadratures.push_back(s.quadrature);
  for (const std::size_t i : settings_.from_zero) series[i].from_zero = true;
  look_.watch(quadratures);
  events_ = EventWatch<N>(std::move(series));
  watch_kinks();
}

// ---- the dense output -----------------------------------------------------------------------------------------------

template <Number N>
typename Stepper<N>::W Stepper<N>::quadrature(std::size_t i, const W& dt) const {
  W s(0);
  for (int k = order_ - 1; k >= 0; --k) s = s * dt + convert<W>(expander_.quadrature(i, k));
  return s;
}

template <Number N>
Outcome Stepper<N>::at(const W& t, Expansion<W>& point, bool leading) const {
  std::vector<W> state, guess;
  foretell(t, state, guess);
  point.load(t, state, guess);
  if (!leading && expander_.foretells_consistent_states()) return {};
  Outcome o = point.prepare();
  if (o.ok()) o = point.project();
  if (o.ok() && leading) o = point.solve();
  if (!one_sided_ || o.kind != OutcomeKind::not_a_number) return o;
  // The equations have no value here. The derivatives right after the point replace it if the motion goes on.
  if (one_sided_->stopped()) guess.assign(guess.size(), W(std::numeric_limits<double>::quiet_NaN()));
  point.load(t, state, guess);
  point.evaluate();
  return {};
}

template class Stepper<double>;
template class Stepper<long double>;
template class Stepper<Quad>;
template class Stepper<Multi>;

}  // namespace anholon
