#include "integrate/expander.h"

#include <cmath>

#include "integrate/sigma_schedule.h"

namespace anholon {

namespace {

// Notes where an expansion is begun. The state in a kernel's lane is read later.
template <Number N>
void note_begun(MotionTrack<N>& track, const std::vector<Wider<N>>& guess, bool by_kernel, bool mapped) {
  MotionState<N>& b = track.begun().at.motion;
  const MotionState<N>& now = track.now;
  track.begun().by_kernel = by_kernel;
  b.t = now.t;
  if (by_kernel && mapped) b.state.clear();
  if (!by_kernel) {
    b.state = now.state;
    b.carry = now.carry;
    b.carry.resize(now.state.size(), Wider<N>(0));
    b.leading = guess;
    b.own.clear();
  }
  if (!now.integrals.empty()) {
    b.integrals = now.integrals;
    b.integral_carry = now.integral_carry;
  }
  b.record = now.record;
}

// Notes what the reference starts from.
template <Number N>
void note_reference(MotionTrack<N>& track, const Expansion<N>& series) {
  track.begun().at.direction = series.weakest_direction();
  track.now.own.clear();
  if (track.now.carry.empty()) track.now.carry.assign(track.now.state.size(), Wider<N>(0));
}

// Computes the state by the polynomials of the reference.
template <Number N>
void reference_state_at(const ReferenceExpansion<N>& reference, const Expansion<Wider<N>>& point, const Wider<N>& h,
                        std::vector<Wider<N>>& state, std::vector<Wider<N>>& leading) {
  std::vector<Wider<N>> increments;
  reference.polynomial(h, point, increments, leading);
  point.state(state);
  for (std::size_t i = 0; i < state.size(); ++i) state[i] += increments[i];
}

}  // namespace

template <Number N>
void ReferenceExpander<N>::begin(MotionTrack<N>& track, const std::vector<W>& guess, bool again) {
  if (!again) track.begin_next();
  note_begun(track, guess, false, false);
  track.now.record.careful = false;
}

template <Number N>
Outcome ReferenceExpander<N>::prepare(MotionTrack<N>& track, const std::vector<W>& guess) {
  note_reference(track, series());
  return reference_.prepare(track.now, guess);
}

template <Number N>
void ReferenceExpander<N>::state_at(const MotionTrack<N>&, const W& h, std::vector<W>& state,
                                    std::vector<W>& leading) const {
  reference_state_at(reference_, point_, h, state, leading);
}

template class ReferenceExpander<long double>;
template class ReferenceExpander<Quad>;
template class ReferenceExpander<Multi>;

GuardedExpander::GuardedExpander(const Program& program, const std::vector<double>& parameters,
                                 const std::vector<W>& wide_parameters, const StepSettings& settings, int order)
    : program_(&program), parameters_(parameters), wide_parameters_(wide_parameters), order_(order),
      measure_(settings.measure), shrink_(step_shrink(settings.log_tolerance, order)) {}

ReferenceExpansion<double>& GuardedExpander::reference() const {
  if (!reference_) reference_ = std::make_unique<ReferenceExpansion<double>>(*program_, parameters_, order_);
  return *reference_;
}

Expansion<GuardedExpander::W>& GuardedExpander::solution() const {
  if (!solution_) solution_ = std::make_unique<Expansion<W>>(*program_, wide_parameters_, 1);
  return *solution_;
}

void GuardedExpander::set_parameters(const std::vector<double>& parameters, const std::vector<W>& wide_parameters) {
  parameters_ = parameters;
  wide_parameters_ = wide_parameters;
  if (reference_) reference_->series().set_parameters(parameters);
  if (solution_) solution_->set_parameters(wide_parameters);
}

// Forgets the motion: the next one is another motion.
void GuardedExpander::restart() {
  if (kernel_) kernel_->drop();
  maker_ = Maker::reference;
  known_ = Known::values;
  awaits_kernel_ = false;
}

void GuardedExpander::reset() {
  restart();
  by_kernel_ = 0;
  if (kernel_) kernel_->forget_suspicion();
}

bool GuardedExpander::kernel_serves(const StepRecord<double>& record) const {
  const bool look = measure_ && (record.first_sigma == 0 || sigma_is_due(record.steps));
  return kernel_ && !look && !record.careful;
}

// `again`: the expansion replaces the present one, from the same place or from another one of the same step. A kernel
// with other lanes is not used for such an expansion.
void GuardedExpander::begin(MotionTrack<double>& track, const std::vector<W>& guess, bool again) {
  awaits_kernel_ = kernel_serves(track.now.record) && (!again || alone());
  if (!again) {
    if (!awaits_kernel_) take_back(track, false);
    track.begin_next();
    if (kernel_) kernel_->forget_suspicion();
  }
  note_begun(track, guess, awaits_kernel_, kernel_ && kernel_->mapped());
  track.now.record.careful = false;
  if (awaits_kernel_) kernel_->load(track, guess);
}

bool GuardedExpander::end_by_kernel(MotionTrack<double>& track) {
  if (!std::exchange(awaits_kernel_, false)) return false;
  if (!kernel_->serves(track.now.record, measure_, maker_ == Maker::kernel)) {
    kernel_->take_back_as_begun(track);
    return false;
  }
  maker_ = Maker::kernel;
  known_ = Known::nothing;
  ++by_kernel_;
  return true;
}

bool GuardedExpander::end_at_once(MotionTrack<double>& track) {
  if (!kernel_->serves_at_once(track.now.record, measure_)) return false;
  awaits_kernel_ = false;
  known_ = Known::nothing;
  ++by_kernel_;
  return true;
}

void GuardedExpander::follow(MotionTrack<double>& track, const OrdinaryCourse& course) {
  MotionState<double>& now = track.now;
  const auto note = [&] {
    track.begin_next();
    note_begun(track, now.leading, true, kernel_->mapped());
  };
  const auto step = [&](const OrdinaryCourse::Step& s) {
    now.t = s.to;
    now.record.last_step = std::abs(s.length);
    if (now.record.worst_constraint < W(s.drift)) now.record.worst_constraint = s.drift;
    ++now.record.steps;
    note();
  };
  if (course.steps > 1) {
    // Only the last two expansions can still be asked for.
    now.record.steps += course.steps - 2;
    step(course.before);
  }
  if (course.steps > 0) step(course.last);
  by_kernel_ += course.steps;
  if (course.steps > 0 || course.aimed) {
    known_ = Known::nothing;
    kernel_->follow_pivots(course.pivots);
  }
  if (!course.aimed) return;
  if (now.record.worst_constraint < W(course.drift)) now.record.worst_constraint = course.drift;
  awaits_kernel_ = false;
  ++by_kernel_;
}

Outcome GuardedExpander::prepare(MotionTrack<double>& track, const std::vector<W>& guess) {
  note_reference(track, series());
  maker_ = Maker::reference;
  known_ = Known::values;
  return reference().prepare(track.now, guess);
}

MotionState<double> GuardedExpander::motion(const MotionTrack<double>& track, bool expanded) const {
  MotionState<double> m = track.now;
  if (kernel_) kernel_->read(m, expanded);
  if (m.carry.empty()) m.carry.assign(m.state.size(), W(0));
  return m;
}

// A kernel's expansions do not change the direction.
StepperState<double> GuardedExpander::begun(const MotionTrack<double>& track) const {
  if (!kernel_) return track.begun().at;
  MotionTrack<double> all = track;
  kernel_->read_begun(all);
  if (kernel() && reference_) all.begun().at.direction = series().weakest_direction();
  return all.begun().at;
}

const Expansion<GuardedExpander::W>& GuardedExpander::point(const MotionTrack<double>& track, bool values) const {
  if (known_ == Known::nothing) {
    const W& begun = track.begun().at.motion.t;
    solution().load(begun, kernel()->base(begun), kernel()->leading());
    known_ = Known::solution;
    // A kernel with unknowns of its own has no multipliers.
    if (kernel()->mapped() && solution().prepare().ok()) solution().solve();
  }
  if (values && known_ == Known::solution) {
    solution().evaluate();
    known_ = Known::values;
  }
  return solution();
}

void GuardedExpander::state_at(const MotionTrack<double>& track, const W& h, std::vector<W>& state,
                               std::vector<W>& leading) const {
  if (kernel()) return kernel()->state_at(track.begun().at.motion.t, h, state, leading);
  reference_state_at(reference(), solution(), h, state, leading);
}

void GuardedExpander::own_state_at(const MotionTrack<double>& track, const W& h, std::vector<W>& state,
                                   std::vector<W>& own, std::vector<W>& leading) const {
  const bool mapped = kernel() && kernel()->mapped();
  (mapped ? state : own).clear();
  if (mapped)
    kernel()->own_state_at(h, own, leading);
  else
    state_at(track, h, state, leading);
}

}  // namespace anholon
