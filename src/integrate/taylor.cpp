#include "integrate/taylor.h"

#include <algorithm>
#include <cmath>

#include "kernel/kernel.h"

namespace anholon {

namespace {

// Steps smaller than this many round-offs of the time are a collapse.
constexpr int kCollapsedRoundoffs = 16;
constexpr double kBlowUp = 1e100;
// So many steps tell how many more it will take.
constexpr std::size_t kStepsToJudge = 1000;

// s + x with the round-off kept in `carry`.
template <Number N>
void add_compensated(N& s, N& carry, const N& x) {
  const N y = x + carry, sum = s + y;
  carry = abs(s) >= abs(y) ? N(N(s - sum) + y) : N(N(y - sum) + s);
  s = sum;
}

Outcome blow_up() {
  return {OutcomeKind::blow_up, "the motion grows without bound",
          "look at the last good state: a velocity or position diverges"};
}

Outcome becomes_singular() {
  return {OutcomeKind::singular, "the system Jacobian becomes singular", "end the motion before"};
}

}  // namespace

int least_work_order(double log_tolerance) { return std::max(4, static_cast<int>(std::ceil(-log_tolerance / 2 + 1))); }

int taylor_order(double log_tolerance) {
  constexpr int kMore = 4;
  return least_work_order(log_tolerance) + (asks_for_last_digits(log_tolerance) ? 0 : kMore);
}

bool asks_for_last_digits(double log_tolerance) {
  constexpr double kLog = -32.3;  // of a little less than 1e-14
  return log_tolerance <= kLog;
}

template <Number N>
Stepper<N>::Stepper(const Program& program, const std::vector<N>& parameters, const std::vector<W>& wide_parameters,
                    const StepSettings& settings)
    : program_(&program), settings_(settings),
      order_(settings.order > 0 ? settings.order : taylor_order(settings.log_tolerance)), parameters_(parameters),
      expansion_(program, parameters, order_ - 1), point_(program, wide_parameters, 1),
      check_(settings_.log_tolerance) {
  find_hiding(program.tape.main_end);
}

template <Number N>
Stepper<N>::~Stepper() = default;

template <Number N>
void Stepper<N>::place(const W& t, const std::vector<W>& state, const std::vector<W>& leading) {
  started_ = t_ = before_ = t;
  state_ = state;
  carry_.assign(state.size(), W(0));
  leading_ = leading;
  own_.clear();
  integrals_.assign(program_->quadratures, W(0));
  integral_carry_ = integrals_;
  record_ = {};
  record_.smallest_sigma_t = t;
  expansions_ = by_kernel_count_ = 0;
  by_kernel_ = suspected_ = loaded_ = away_ = expanded_ = singular_ahead_ = false;
  short_kinks_ = 0;
  limit_ = W(0);
  check_.forget();
  sigma_ = N(0);
  expansion_.set_weakest_direction({});
  fired_.clear();
  events_.restart();
  begun_[0] = begun_[1] = {};
  carried_ = false;
}

template <Number N>
Outcome Stepper<N>::start(const W& t, const std::vector<W>& state, const std::vector<W>& leading, bool kernel) {
  place(t, state, leading);
  record_.careful = !kernel;
  return expand(leading_);
}

template <Number N>
Outcome Stepper<N>::take_over(const Stepper& other) {
  adopt(other);
  return expand(leading_);
}

template <Number N>
Outcome Stepper<N>::restart(const std::vector<W>& state) {
  settle();
  before_ = t_;  // the last step's polynomial is not this state's
  state_ = state;
  own_.clear();
  carry_.assign(state.size(), W(0));
  carried_ = false;
  events_.restart();
  fired_.clear();
  short_kinks_ = 0;
  limit_ = W(0);
  check_.forget();
  // How far what was set lies from the constraints is no drift.
  const W drift = record_.worst_constraint;
  Outcome o = expand(leading_);
  record_.worst_constraint = drift;
  return o;
}

template <Number N>
void Stepper<N>::adopt(const Stepper& other) {
  other.settle();
  away_ = false;
  limit_ = W(0);
  check_.forget();
  events_ = other.events_;
  started_ = other.started_;
  t_ = before_ = other.t_;
  state_ = other.state_;
  own_.clear();
  carry_ = other.carry_;
  carried_ = false;
  leading_ = other.leading_;
  integrals_ = other.integrals_;
  integral_carry_ = other.integral_carry_;
  record_.steps = other.record_.steps;
  record_.worst_constraint = other.record_.worst_constraint;
  record_.worst_equation = other.record_.worst_equation;
  record_.first_sigma = other.record_.first_sigma;
  record_.smallest_sigma = other.record_.smallest_sigma;
  record_.smallest_sigma_t = other.record_.smallest_sigma_t;
  record_.weakest = other.record_.weakest;
}

template <Number N>
Outcome Stepper<N>::resume(const StepperState<N>& b) {
  away_ = false;
  limit_ = W(0);
  check_.forget();
  started_ = t_ = before_ = b.t;
  record_ = b;
  sigma_ = b.sigma_before;
  state_ = b.state;
  own_ = b.own;
  own_leading_ = b.own_leading;
  carry_ = b.carry;
  carried_ = false;
  leading_ = b.leading;
  integrals_ = b.integrals;
  integral_carry_ = b.integral_carry;
  expansion_.set_weakest_direction(b.direction);
  if (!b.sides.empty()) events_.set_sides(b.sides);
  return expand(leading_);
}

template <Number N>
void Stepper<N>::note_sigma(const N& sigma) {
  if (record_.first_sigma == N(0)) record_.first_sigma = sigma;
  if (!(sigma < record_.smallest_sigma)) return;
  record_.smallest_sigma = sigma;
  record_.smallest_sigma_t = t_;
  const std::vector<N>& v = expansion_.weakest_direction();
  for (std::size_t j = record_.weakest = 0; j < v.size(); ++j)
    if (abs(v[j]) > abs(v[record_.weakest])) record_.weakest = j;
}

// At the present pace, and at that of the whole motion so far, the end lies beyond the step limit.
template <Number N>
bool Stepper<N>::end_out_of_reach(const W& h, const W& left) const {
  if (record_.steps < kStepsToJudge) return false;
  const double mean = std::abs(to_double(W(t_ - started_))) / static_cast<double>(record_.steps);
  return std::abs(to_double(left)) >
         std::max(mean, to_double(h)) * static_cast<double>(settings_.most_steps - record_.steps);
}

template <Number N>
Outcome Stepper<N>::step(const W& end) {
  if (!begins()) return outcome(false);
  if (loaded_) kernel_->begin();
  if (!aims(end)) return outcome(false);
  for (EndOfStep there = EndOfStep::elsewhere; by_kernel_ && there == EndOfStep::elsewhere;) {
    kernel_->advance();
    kernel_->start_next();
    there = looks_at_end(end);
    if (there == EndOfStep::failed) return outcome(false);
  }
  return outcome(finishes());
}

template <Number N>
bool Stepper<N>::begins() {
  if (settings_.cancelled && settings_.cancelled())
    return fail({OutcomeKind::interrupted, "interrupted", "what was computed is kept"});
  if (record_.steps >= settings_.most_steps)
    return fail({OutcomeKind::interrupted, "the step limit is reached", "allow more steps, or loosen the tolerance"});
  if (!expanded_) begin_expansion(leading_);
  kinks_before_ = kinks_;
  return true;
}

template <Number N>
bool Stepper<N>::aims_with_care(const W& end) {
  const W left = end - t_;
  const bool forward = left > W(0);
  if (one_sided_) return aims_one_sided(left);
  W h = horizon();
  // Not from what is left to the end: steps must not depend on where a run is to stop, if another one is to go on from
  // there.
  if (program_->nonlinear) h = abs(on_the_branch(forward ? h : W(-h)));
  const W floor = convert<W>(unit_roundoff<N>()) * W(kCollapsedRoundoffs) * abs(t_);
  if (!(h > floor))
    return fail({OutcomeKind::step_collapse, "the step size fell below what the time can resolve",
                 "the motion approaches a singularity: stop before it, or look at the last good state"});
  if (end_out_of_reach(h, left))
    return fail({OutcomeKind::interrupted,
                 "the end lies more than " + std::to_string(settings_.most_steps) + " steps ahead: a step is about " +
                     number_text(to_double(h), 2) + " long",
                 "end the motion earlier, or take what is very fast or very stiff out of the model"});
  if (singular_ahead_) return fail(becomes_singular());
  const W whole = h;
  if (!(h < abs(left))) h = abs(left);
  if (!forward) h = -h;
  if (!ends_as_foretold(h, whole)) return false;
  if (const std::optional<W> met = by_kernel_ && !suspected_ ? std::nullopt : singular_within(h)) {
    // Up to where J is still regular.
    constexpr double kShortOf = 1 - 1e-7;
    h = *met * W(kShortOf);
    singular_ahead_ = true;
    if (!(abs(h) > floor)) return fail(becomes_singular());
  }
  fired_.clear();
  if (!events_.empty()) {
    N to = convert<N>(h);
    const N length = to;
    fired_ = events_.look(expansion_, order_ - 1, convert<N>(t_), to,
                          at_kink_ ? std::optional<N>(convert<N>(looked_)) : std::nullopt,
                          [this](std::size_t i, const N& where) { return quadrature_ahead(i, where); });
    if (to != length) h = convert<W>(to), singular_ahead_ = false;
  }
  // The step that t can show exactly: otherwise the time loses a round-off at every step.
  if (h == left)
    aim_at(end, true);
  else
    aim_at(convert<W>(convert<N>(W(t_ + h))), false);
  return true;
}

// An ordinary step, of the length that the series allow.
template <Number N>
bool Stepper<N>::nothing_in_the_way() const {
  return by_kernel_ && !suspected_ && !singular_ahead_ && !may_touch_zero_ && short_kinks_ == 0 && fired_.empty() &&
         events_.empty() &&
         to_double(horizon()) > std::abs(to_double(t_)) * (2 * kCollapsedRoundoffs * unit_roundoff<double>());
}

template <Number N>
bool Stepper<N>::aims_freely(const W& end) {
  if (!nothing_in_the_way()) return false;
  const W left = end - t_, h = horizon();
  if (!(h < abs(left)) || end_out_of_reach(h, left)) return false;
  const W to = convert<W>(convert<N>(W(left > W(0) ? t_ + h : t_ - h)));
  looked_ = to - t_;
  at_kink_ = false;
  aim_at(to, false);
  return true;
}

template <Number N>
void Stepper<N>::aim_at(const W& t, bool arrives) {
  aimed_ = t;
  arrives_ = arrives;
  if (!by_kernel_) return;
  const W h = t - t_;
  if (looked_ != W(0) && abs(h) < abs(looked_)) looked_ = h;
  if (looked_ == W(0)) return send_kernel(h);
  find_hidden(looked_);
  check_.begin(convert<N>(looked_), hidden_);
  send_kernel(convert<W>(check_.where()));
}

// Where the state is not with the kernel.
template <Number N>
bool Stepper<N>::goes_on(const W& h) {
  if (by_kernel_) {
    base_state_.swap(state_);
    advanced_by_kernel(h, base_state_, state_, leading_);
    if (!std::all_of(state_.begin(), state_.end(), [](const W& x) { return abs(x) < W(kBlowUp); }))
      return state_.swap(base_state_), false;
    return true;
  }
  polynomial(h, change_, leading_);
  next_ = state_;
  for (std::size_t i = 0; i < next_.size(); ++i) {
    add_compensated(next_[i], carry_[i], change_[i]);
    if (!is_finite(next_[i]) || std::abs(to_double(next_[i])) > kBlowUp) return false;
  }
  std::swap(state_, next_);
  return true;
}

template <Number N>
bool Stepper<N>::finishes() {
  const W h = aimed_ - t_;
  record_.last_step = abs(h);
  record_.sigma_before = sigma_;
  if (by_kernel_ && mapped()) away_ = true;  // whoever has read the state has left it as it was
  if (away_) {
    // So that a NaN is one, too.
    if (!(kernel_->largest(lane_) < kBlowUp)) return settle_at_base(), fail(blow_up());
  } else if (!goes_on(h)) {
    return fail(blow_up());
  }
  for (std::size_t i = 0; i < integrals_.size(); ++i) {
    W s(0);
    for (int k = order_ - 1; k >= 0; --k) s = (s + convert<W>(quadrature_coefficient(i, k)) / W(k + 1)) * h;
    add_compensated(integrals_[i], integral_carry_[i], s);
  }
  before_ = t_;
  t_ = aimed_;
  expanded_ = false;
  limit_ = W(0);
  check_.forget();
  ++record_.steps;
  // Others in the kernel go on while this one has arrived.
  if (arrives_) settle();
  return true;
}

template <Number N>
typename Stepper<N>::W Stepper<N>::quadrature(std::size_t i, const W& dt) const {
  W s(0);
  for (int k = order_ - 1; k >= 0; --k) s = s * dt + convert<W>(quadrature_coefficient(i, k));
  return s;
}

template <Number N>
Outcome Stepper<N>::at(const W& t, Expansion<W>& point, bool leading) const {
  std::vector<W> state, guess;
  on_polynomial(t - before_, state, guess);
  point.load(t, state, guess);
  Outcome o = point.prepare();
  if (o.ok()) o = point.project();
  if (o.ok() && leading) o = point.solve();
  if (!one_sided_ || o.kind != OutcomeKind::not_a_number) return o;
  // The equations have no value here: what the motion has right after the point stands for it.
  point.load(t, state, guess);
  point.evaluate();
  return {};
}

template class Stepper<double>;
template class Stepper<long double>;
template class Stepper<Quad>;
template class Stepper<Multi>;

}  // namespace anholon
