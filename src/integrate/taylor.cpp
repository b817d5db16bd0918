#include "integrate/taylor.h"

#include <algorithm>
#include <cmath>

#include "integrate/kink.h"
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

Outcome blow_up() { return {OutcomeKind::blow_up, "the motion grows without bound", "look at the last good state: a velocity or position diverges"}; }

// A step ends past a kink by the tolerance and this many round-offs, so that the next one starts surely on the other side.
constexpr int kPastKink = 32;
// Kinks met so soon after another one are other kinks, until they are too many.
constexpr int kMostShortKinks = 20;

}  // namespace

int taylor_order(double log_tolerance) {
  return std::max(4, static_cast<int>(std::ceil(-log_tolerance / 2 + 1)));
}

template <Number N>
Stepper<N>::Stepper(const Program& program, const std::vector<N>& parameters, const std::vector<W>& wide_parameters, const StepSettings& settings)
    : program_(&program), settings_(settings), order_(settings.order > 0 ? settings.order : taylor_order(settings.log_tolerance)),
      parameters_(parameters), expansion_(program, parameters, order_ - 1), point_(program, wide_parameters, 1) {}

template <Number N>
Stepper<N>::~Stepper() = default;

template <Number N>
void Stepper<N>::place(const W& t, const std::vector<W>& state, const std::vector<W>& leading) {
  started_ = t_ = before_ = t;
  state_ = state;
  carry_.assign(state.size(), W(0));
  leading_ = leading;
  integrals_.assign(program_->quadratures, W(0));
  integral_carry_ = integrals_;
  steps_ = expansions_ = by_kernel_count_ = 0;
  by_kernel_ = turned_ = careful_ = loaded_ = expanded_ = singular_ahead_ = false;
  short_kinks_ = 0;
  least_health_ = N(1);
  health_before_ = 0;
  sigma_ = sigma_before_ = first_sigma_ = N(0);
  smallest_sigma_ = N(1);
  smallest_sigma_t_ = t;
  weakest_ = 0;
  expansion_.set_weakest_direction({});
  last_step_ = branch_step_ = worst_constraint_ = worst_equation_ = W(0);
  fired_.clear();
  events_.restart();
  begun_[0] = begun_[1] = {};
  carried_ = false;
}

template <Number N>
Outcome Stepper<N>::start(const W& t, const std::vector<W>& state, const std::vector<W>& leading) {
  place(t, state, leading);
  return expand(leading_);
}

template <Number N>
Outcome Stepper<N>::take_over(const Stepper& other) {
  adopt(other);
  return expand(leading_);
}

template <Number N>
Outcome Stepper<N>::restart(const std::vector<W>& state) {
  before_ = t_;  // the last step's polynomial is not this state's
  state_ = state;
  carry_.assign(state.size(), W(0));
  carried_ = false;
  events_.restart();
  fired_.clear();
  short_kinks_ = 0;
  // How far what was set lies from the constraints is no drift.
  const W drift = worst_constraint_;
  Outcome o = expand(leading_);
  worst_constraint_ = drift;
  return o;
}

template <Number N>
void Stepper<N>::adopt(const Stepper& other) {
  events_ = other.events_;
  started_ = other.started_;
  t_ = before_ = other.t_;
  state_ = other.state_;
  carry_ = other.carry_;
  carried_ = false;
  leading_ = other.leading_;
  integrals_ = other.integrals_;
  integral_carry_ = other.integral_carry_;
  steps_ = other.steps_;
  worst_constraint_ = other.worst_constraint_;
  worst_equation_ = other.worst_equation_;
  first_sigma_ = other.first_sigma_;
  smallest_sigma_ = other.smallest_sigma_;
  smallest_sigma_t_ = other.smallest_sigma_t_;
  weakest_ = other.weakest_;
}

template <Number N>
Outcome Stepper<N>::resume(const StepperState<N>& b) {
  started_ = t_ = before_ = b.t;
  state_ = b.state;
  carry_ = b.carry;
  carried_ = false;
  leading_ = b.leading;
  integrals_ = b.integrals;
  integral_carry_ = b.integral_carry;
  branch_step_ = b.branch_step;
  steps_ = b.steps;
  worst_constraint_ = b.worst_constraint;
  worst_equation_ = b.worst_equation;
  first_sigma_ = b.first_sigma;
  smallest_sigma_ = b.smallest_sigma;
  smallest_sigma_t_ = b.smallest_sigma_t;
  weakest_ = b.weakest;
  expansion_.set_weakest_direction(b.direction);
  sigma_ = sigma_before_ = b.sigma_before;
  last_step_ = b.last_step;
  least_health_ = b.least_health;
  careful_ = b.careful;
  if (!b.sides.empty()) events_.set_sides(b.sides);
  return expand(leading_);
}

template <Number N>
void Stepper<N>::note_sigma(const N& sigma) {
  if (first_sigma_ == N(0)) first_sigma_ = sigma;
  if (!(sigma < smallest_sigma_)) return;
  smallest_sigma_ = sigma;
  smallest_sigma_t_ = t_;
  const std::vector<N>& v = expansion_.weakest_direction();
  for (std::size_t j = weakest_ = 0; j < v.size(); ++j)
    if (abs(v[j]) > abs(v[weakest_])) weakest_ = j;
}

template <Number To, Number From>
static void convert_all(const std::vector<From>& from, std::vector<To>& to) {
  to.resize(from.size(), To(0));
  for (std::size_t i = 0; i < from.size(); ++i) to[i] = convert<To>(from[i]);
}

template <Number N>
Outcome Stepper<N>::expand(const std::vector<W>& guess) {
  begin_expansion(guess);
  if (loaded_) kernel_->expand();
  return end_expansion(guess);
}

template <Number N>
void Stepper<N>::begin_expansion(const std::vector<W>& guess) {
  now_ = 1 - now_;
  note_begun(guess);
  loaded_ = load_kernel(guess);
}

template <Number N>
Outcome Stepper<N>::end_expansion(const std::vector<W>& guess) {
  const bool again = expansions_++ > 0, by_kernel = loaded_ && take_from_kernel();
  loaded_ = false;
  Outcome o = by_kernel ? Outcome{} : expand_by_reference(guess);
  if (o.ok() && turned_) return look_back();
  if (!o.ok() && again) expand_again(StepperState<N>(begun_[1 - now_]));
  return o;
}

// Where the kernel belongs to others, too, it is left in peace.
template <Number N>
Outcome Stepper<N>::expand_here(const std::vector<W>& guess) {
  note_begun(guess);
  ++expansions_;
  if (alone_ && load_kernel(guess)) {
    kernel_->expand();
    if (take_from_kernel()) return {};
  }
  return expand_by_reference(guess);
}

// Pivots of the kernel have changed their signs in the last step: whether J was singular on the way is asked of the reference. At both ends first.
template <Number N>
Outcome Stepper<N>::look_back() {
  turned_ = false;
  const std::optional<Mode<N>> before = mode_at(begun_[1 - now_].t, begun_[1 - now_].state), here = mode_at(t_, state_);
  if (before && here && !crossed(*before, *here, program_->system->coordinates)) return {};
  const StepperState<N> now = begun_[now_], last = begun_[1 - now_];
  const W length = last_step_;
  careful_ = true;
  expand_again(last);
  last_step_ = W(0);
  const std::optional<W> met = singular_within(now.t - last.t);
  last_step_ = length;
  if (met) return {OutcomeKind::singular, "the system Jacobian becomes singular at t = " + number_text(to_double(W(last.t + *met)), 12), "end the motion before"};
  careful_ = true;
  const Outcome o = expand_here(now.leading);
  begun_[now_] = now;
  begun_[1 - now_] = last;
  return o;
}

// After a failure: the polynomial of the last good step is still asked for.
template <Number N>
void Stepper<N>::expand_again(const StepperState<N>& last) {
  const W t = t_;
  const std::vector<W> state = state_, carry = carry_, leading = leading_;
  t_ = before_ = last.t;
  state_ = last.state;
  carry_ = last.carry;
  carried_ = false;
  expand_here(last.leading);
  begun_[now_] = last;
  t_ = t;
  state_ = state;
  carry_ = carry;
  carried_ = false;
  leading_ = leading;
  expanded_ = false;
}

template <Number N>
void Stepper<N>::note_begun(const std::vector<W>& guess) {
  StepperState<N>& b = begun_[now_];
  b.t = t_;
  b.state = state_;
  b.carry = carry_;
  b.leading = guess;
  b.integrals = integrals_;
  b.integral_carry = integral_carry_;
  b.branch_step = branch_step_;
  b.steps = steps_;
  b.worst_constraint = worst_constraint_;
  b.worst_equation = worst_equation_;
  b.first_sigma = first_sigma_;
  b.smallest_sigma = smallest_sigma_;
  b.smallest_sigma_t = smallest_sigma_t_;
  b.weakest = weakest_;
  b.sigma_before = sigma_before_;
  b.last_step = last_step_;
  b.least_health = least_health_;
  b.careful = careful_;
}

// Expansions by the kernel change neither the direction nor the sides.
template <Number N>
const StepperState<N>& Stepper<N>::begun() const {
  if (by_kernel_) begun_[now_].direction = expansion_.weakest_direction(), begun_[now_].sides = events_.sides();
  return begun_[now_];
}

template <Number N>
Outcome Stepper<N>::expand_by_reference(const std::vector<W>& guess) {
  begun_[now_].direction = expansion_.weakest_direction();
  begun_[now_].sides = events_.sides();
  by_kernel_ = carried_ = false;
  point_loaded_ = point_valued_ = true;
  convert_all(state_, narrow_state_);
  convert_all(guess, narrow_leading_);
  expansion_.load(convert<N>(t_), narrow_state_, narrow_leading_);
  if (Outcome o = expansion_.prepare(); !o.ok()) return o;
  sigma_ = expansion_.smallest_singular_value();
  note_sigma(sigma_);
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
    worst_constraint_ = std::max(worst_constraint_, expansion_.drift());
    worst_equation_ = std::max(worst_equation_, expansion_.equation_residual());
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
    worst_constraint_ = std::max(worst_constraint_, point_.drift());
    worst_equation_ = std::max(worst_equation_, point_.equation_residual());
  }
  if (Outcome o = expansion_.extend(); !o.ok()) return o;
  horizon_ = step_size();
  // What is watched may change faster than the motion, on which it has no influence: the density of thin air.
  const double reach = std::min(kinks_log_reach<N>(expansion_.machine(), kinks_end(), order_ - 1, settings_.log_tolerance),
                                events_.log_reach(expansion_, order_ - 1, settings_.log_tolerance));
  if (const N known(std::exp(reach)); known < horizon_) horizon_ = known;
  expanded_ = true;
  return {};
}

// h = (rho / e^2) exp(-0.7/(p-1)), rho the smaller root of |x| / |x_k| for the last two orders k,
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
  return horizon(last_weight, before_weight, pole);
}

template <Number N>
N Stepper<N>::horizon(double last, double before_last, double pole) const {
  constexpr double kFar = 300;
  // e^-2 per order suits order = -ln(tol)/2 + 1; another order keeps h^p rho^-p = tol.
  const double shrink = settings_.order > 0 ? -settings_.log_tolerance / order_ : 2.0;
  const double log_rho = std::min({kFar, -last / order_, -before_last / (order_ - 1)}), log_pole = std::min(kFar, -pole / (order_ - 1));
  return N(std::exp(std::min(log_rho - shrink - 0.7 / (order_ - 1), log_pole - 0.7)));
}

template <Number N>
void Stepper<N>::polynomial(const W& h, std::vector<W>& increments, std::vector<W>& leading) const {
  const Program& p = *program_;
  increments.assign(expansion_.state_size(), W(0));
  leading.assign(p.unknowns(), W(0));
  for (std::size_t j = 0; j < p.unknowns(); ++j) {
    const int d = p.d[j], top = degree(j);
    for (int k = 0; k <= d; ++k) {
      // sum_i x_(k+i) (k+i)!/i! h^i, without the term of order 0 (that is the state itself).
      W s(0);
      for (int i = top - k; i >= 1; --i) {
        W factor(1);
        for (int f = 1; f <= k; ++f) factor = factor * W(i + f);
        s = (s + dense(j, k + i) * factor) * h;
      }
      if (k < d) increments[expansion_.offset(j) + static_cast<std::size_t>(k)] = s;
      else leading[j] = point_.derivative(j, k) + s;
    }
  }
}

// State and leading derivatives h beyond where the expansion was made.
template <Number N>
void Stepper<N>::on_polynomial(const W& h, std::vector<W>& state, std::vector<W>& leading) const {
  if (by_kernel_) {
    advance_kernel(h);
    return advanced_by_kernel(h, expanded_ ? state_ : base_state_, state, leading);
  }
  std::vector<W> increments;
  polynomial(h, increments, leading);
  point().state(state);
  for (std::size_t i = 0; i < state.size(); ++i) state[i] += increments[i];
}

// J and its LU at t + h on the polynomial, or nothing where it has none. What was met elsewhere says nothing there: the iteration
// for the singular value starts anew, so that a run that goes on finds the same.
template <Number N>
Expansion<N>* Stepper<N>::ahead(const W& h) {
  std::vector<W> leading, state;
  on_polynomial(h, state, leading);
  return prepared(t_ + h, state, leading);
}

template <Number N>
Expansion<N>* Stepper<N>::prepared(const W& t, const std::vector<W>& state, const std::vector<W>& leading) {
  if (!ahead_) ahead_ = std::make_unique<Expansion<N>>(*program_, parameters_, 1);
  std::vector<N> narrow_state, narrow_leading;
  convert_all(state, narrow_state);
  convert_all(leading, narrow_leading);
  ahead_->load(convert<N>(t), narrow_state, narrow_leading);
  ahead_->set_weakest_direction({});
  return ahead_->prepare().ok() ? ahead_.get() : nullptr;
}

// Of the polynomial itself, in formulas that follow from it without derivatives beyond the leading ones.
template <Number N>
std::optional<N> Stepper<N>::quadrature_ahead(std::size_t i, const N& h) {
  Expansion<N>* there = ahead(convert<W>(h));
  if (!there) return std::nullopt;
  there->evaluate_quadratures();
  const N value = there->quadrature(i)[0];
  return is_finite(value) ? std::optional<N>(value) : std::nullopt;
}

template <Number N>
bool Stepper<N>::near_in_branch(const W& h) {
  const Expansion<N>* there = ahead(h);
  return there && near(expansion_, *there);
}

// Steps end where J may become singular, and shrink towards a singular point.
template <Number N>
typename Stepper<N>::W Stepper<N>::on_the_branch(W h) {
  // From a horizon of e^300 (a polynomial motion) to far below any step.
  constexpr int kMostHalvings = 600;
  if (branch_step_ > W(0) && abs(h) > branch_step_ * W(4)) h = h > W(0) ? branch_step_ * W(4) : branch_step_ * W(-4);
  for (int k = 0; k < kMostHalvings && !(near_in_branch(h) && near_in_branch(h * W(0.5))); ++k) h = h * W(0.5);
  branch_step_ = abs(h);
  return h;
}

template <Number N>
std::optional<Mode<N>> Stepper<N>::mode_ahead(const W& h) {
  return mode_of(ahead(h));
}

template <Number N>
std::optional<Mode<N>> Stepper<N>::mode_at(const W& t, const std::vector<W>& state) {
  return mode_of(prepared(t, state, {}));
}

template <Number N>
std::optional<Mode<N>> Stepper<N>::mode_of(Expansion<N>* there) {
  if (!there) return std::nullopt;
  const N sigma = there->smallest_singular_value();
  return weakest_mode(*there, sigma);
}

// How far from t_ the first singular point is that is met within h; nothing if there is none.
template <Number N>
std::optional<typename Stepper<N>::W> Stepper<N>::singular_within(const W& h) {
  constexpr double kFaster = 0.6, kLonger = 1.5, kVanished = 1e-6;
  constexpr int kBisections = 60;
  // A singular value that vanishes within the step has fallen by more than half in one as long.
  const bool suspected = by_kernel_ || last_step_ == W(0) || sigma_ < sigma_before_ * N(kFaster) || abs(h) > last_step_ * W(kLonger);
  if (!suspected) return std::nullopt;
  const std::size_t n = program_->system->coordinates;
  const std::optional<Mode<N>> here = by_kernel_ ? mode_at(t_, state_) : weakest_mode(expansion_, sigma_);
  if (!here) return std::nullopt;
  Mode<N> low = *here;
  const N start = low.sigma;
  const std::optional<Mode<N>> end = mode_ahead(h);
  if (!end || !crossed(low, *end, n)) return std::nullopt;
  W from(0), to = h;
  for (int k = 0; k < kBisections; ++k) {
    const W middle = from + (to - from) * W(0.5);
    if (middle == from || middle == to) break;
    std::optional<Mode<N>> m = mode_ahead(middle);
    if (!m) return middle;
    if (crossed(low, *m, n)) to = middle;
    else from = middle, low = std::move(*m);
  }
  return low.sigma < start * N(kVanished) ? std::optional<W>(from) : std::nullopt;
}

// At the present pace, and at that of the whole motion so far, the end lies beyond the step limit.
template <Number N>
bool Stepper<N>::end_out_of_reach(const W& h, const W& left) const {
  if (steps_ < kStepsToJudge) return false;
  const double mean = std::abs(to_double(W(t_ - started_))) / static_cast<double>(steps_);
  return std::abs(to_double(left)) > std::max(mean, to_double(h)) * static_cast<double>(settings_.most_steps - steps_);
}

template <Number N>
Outcome Stepper<N>::step(const W& end) {
  if (Outcome o = begin_step(); !o.ok()) return o;
  if (loaded_) kernel_->expand();
  if (Outcome o = aim(end); !o.ok()) return o;
  if (by_kernel_) kernel_->advance();
  return finish_step();
}

template <Number N>
Outcome Stepper<N>::begin_step() {
  if (settings_.cancelled && settings_.cancelled())
    return {OutcomeKind::interrupted, "interrupted", "what was computed is kept"};
  if (steps_ >= settings_.most_steps)
    return {OutcomeKind::interrupted, "the step limit is reached", "allow more steps, or loosen the tolerance"};
  if (!expanded_) begin_expansion(leading_);
  return {};
}

template <Number N>
Outcome Stepper<N>::aim(const W& end) {
  if (!expanded_)
    if (Outcome o = end_expansion(leading_); !o.ok()) return o;
  const W left = end - t_;
  const bool forward = left > W(0);
  W h = convert<W>(horizon_);
  // Not from what is left to the end: steps must not depend on where a run is to stop, if another one is to go on from there.
  if (program_->nonlinear) h = abs(on_the_branch(forward ? h : W(-h)));
  const W floor = convert<W>(unit_roundoff<N>()) * W(kCollapsedRoundoffs) * abs(t_);
  if (!(h > floor))
    return {OutcomeKind::step_collapse, "the step size fell below what the time can resolve",
            "the motion approaches a singularity: stop before it, or look at the last good state"};
  if (end_out_of_reach(h, left))
    return {OutcomeKind::interrupted, "the end lies more than " + std::to_string(settings_.most_steps) + " steps ahead: a step is about " + number_text(to_double(h), 2) + " long",
            "end the motion earlier, or take what is very fast or very stiff out of the model"};
  if (singular_ahead_) return {OutcomeKind::singular, "the system Jacobian becomes singular", "end the motion before"};
  const bool last = !(h < abs(left));
  if (last) h = abs(left);
  if (!forward) h = -h;
  const Kink<N> kink = by_kernel_ && kink_series_.empty() ? Kink<N>{} : first_kink<N>(expansion_.machine(), kinks_end(), order_ - 1, convert<N>(h));
  bool cut = false;
  if (kink.at_start || kink.ahead) {
    // At a kink functions are taken one-sided along the motion: a very short step finds the side.
    const W roundoff = convert<W>(unit_roundoff<N>()) * W(kPastKink) * (abs(t_) > abs(h) ? W(abs(t_)) : W(abs(h)));
    const W past = roundoff + W(std::exp(settings_.log_tolerance)) * abs(h);
    const W where = kink.at_start ? W(0) : convert<W>(kink.where);
    short_kinks_ = !kink.at_start && !(abs(where) > past * W(4)) ? short_kinks_ + 1 : 0;
    if (short_kinks_ > kMostShortKinks)
      return {OutcomeKind::step_collapse, "the motion stays at the kink of an abs, sign, norm, piecewise or table",
              "a force that jumps there, as dry friction does, holds it: put a smooth function in its place, such as tanh(x/0.01) for sign(x)"};
    const W beyond = where + (forward ? past : W(-past));
    if (abs(beyond) < abs(h)) h = beyond, cut = true, ++kinks_;
  } else {
    short_kinks_ = 0;
  }
  if (const std::optional<W> met = by_kernel_ && !suspected_ ? std::nullopt : singular_within(h)) {
    // Up to where J is still regular.
    constexpr double kShortOf = 1 - 1e-7;
    h = *met * W(kShortOf);
    cut = singular_ahead_ = true;
    if (!(abs(h) > floor)) return {OutcomeKind::singular, "the system Jacobian becomes singular", "end the motion before"};
  }
  fired_.clear();
  if (!events_.empty()) {
    N to = convert<N>(h);
    const N whole = to;
    fired_ = events_.look(expansion_, order_ - 1, convert<N>(t_), to, [this](std::size_t i, const N& where) { return quadrature_ahead(i, where); });
    if (to != whole) h = convert<W>(to), cut = true, singular_ahead_ = false;
  }
  // The step that t can show exactly: otherwise the time loses a round-off at every step.
  const W reached = last && !cut ? end : convert<W>(convert<N>(W(t_ + h)));
  h = reached - t_;
  aimed_ = reached;
  if (by_kernel_) kernel_->set_step(lane_, to_double(h));
  return {};
}

template <Number N>
Outcome Stepper<N>::finish_step() {
  const W h = aimed_ - t_;
  last_step_ = abs(h);
  sigma_before_ = sigma_;
  if (by_kernel_) {
    base_state_.swap(state_);
    advanced_by_kernel(h, base_state_, state_, leading_);
    if (!std::all_of(state_.begin(), state_.end(), [](const W& x) { return abs(x) < W(kBlowUp); })) return state_.swap(base_state_), blow_up();
  } else {
    polynomial(h, change_, leading_);
    next_ = state_;
    for (std::size_t i = 0; i < next_.size(); ++i) {
      add_compensated(next_[i], carry_[i], change_[i]);
      if (!is_finite(next_[i]) || std::abs(to_double(next_[i])) > kBlowUp) return blow_up();
    }
    std::swap(state_, next_);
  }
  for (std::size_t i = 0; i < integrals_.size(); ++i) {
    W s(0);
    for (int k = order_ - 1; k >= 0; --k) s = (s + convert<W>(quadrature_coefficient(i, k)) / W(k + 1)) * h;
    add_compensated(integrals_[i], integral_carry_[i], s);
  }
  before_ = t_;
  t_ = aimed_;
  expanded_ = false;
  ++steps_;
  return {};
}

template <Number N>
typename Stepper<N>::W Stepper<N>::quadrature(std::size_t i, const W& dt) const {
  W s(0);
  for (int k = order_ - 1; k >= 0; --k) s = s * dt + convert<W>(quadrature_coefficient(i, k));
  return s;
}

template <Number N>
Outcome Stepper<N>::at(const W& t, Expansion<W>& point) const {
  std::vector<W> state, leading;
  on_polynomial(t - before_, state, leading);
  point.load(t, state, leading);
  if (Outcome o = point.prepare(); !o.ok()) return o;
  if (Outcome o = point.project(); !o.ok()) return o;
  return point.solve();
}

template class Stepper<double>;
template class Stepper<long double>;
template class Stepper<Quad>;
template class Stepper<Multi>;

}  // namespace anholon
