// Makes the Taylor expansions of a stepper: by the reference, or, for doubles, by a kernel while it is healthy and by
// the reference otherwise. Both expanders have the same interface; the number type chooses one when the program is
// compiled.
//
// An expansion is made in parts, because other lanes of a kernel may hold other motions:
// begin() -> the kernel is expanded, if it is awaited -> end_by_kernel(), and if that returns false:
//   prepare() -> solve() [-> extend(), or cut_to() where formulas have no derivatives]
#pragma once
#include "integrate/kernel_expansion.h"
#include "integrate/reference_expansion.h"

namespace anholon {

template <Number N>
class ReferenceExpander {
 public:
  using W = Wider<N>;
  ReferenceExpander(const Program& program, const std::vector<N>& parameters, const std::vector<W>& wide_parameters,
                    const StepSettings& settings, int order)
      : shrink_(step_shrink(settings.log_tolerance, order)), reference_(program, parameters, order),
        point_(program, wide_parameters, 1) {}

  // The kernel that has made the present expansion; nullptr if the reference has made it.
  static constexpr KernelExpansion* kernel() { return nullptr; }
  static constexpr bool accelerated() { return false; }
  static constexpr bool foretells_consistent_states() { return false; }
  static constexpr bool alone() { return true; }
  static constexpr bool suspected() { return false; }
  static constexpr std::size_t expansions_by_kernel() { return 0; }
  int order() const { return reference_.order(); }
  const std::vector<W>& wide_parameters() const { return point_.parameters(); }
  void restart() {}  // no expansion is made
  void reset() {}    // the expansions are not counted

  void begin(MotionTrack<N>& track, const std::vector<W>& guess, bool again);
  static constexpr void expand_kernel() {}
  static constexpr bool end_by_kernel(MotionTrack<N>&) { return false; }
  static constexpr double drift_of_kernel() { return 0; }
  static constexpr void refuse_kernel(MotionTrack<N>&) {}
  Outcome prepare(MotionTrack<N>& track, const std::vector<W>& guess);
  Outcome solve(MotionTrack<N>& track, const std::vector<W>& guess) {
    return reference_.solve(track.now, guess, point_);
  }
  const MissedConstraint<N>& missed() const { return reference_.missed(); }
  Outcome extend() { return reference_.extend(); }
  void cut_to(const MotionState<N>& m, const std::vector<W>& leading) { reference_.cut_to(m, leading, point_); }
  N reach() const { return reference_.reach(shrink_); }

  // show_deciding() copies the series that decide which functions hold into series(), where kinks are looked for;
  // look_for_turns() finds out whether one of them may change its decision within the horizon.
  static constexpr void show_deciding() {}
  static constexpr void look_for_turns(const N&) {}

  bool advance(MotionTrack<N>& track, const W& h) { return reference_.advance(track.now, h, point_); }

  // The next functions read the motion from a kernel's lane, or take it out.
  MotionState<N> motion(const MotionTrack<N>& track, bool) const { return track.now; }
  StepperState<N> begun(const MotionTrack<N>& track) const { return track.begun().at; }
  void take_back(MotionTrack<N>&, bool) {}
  static constexpr void round_state() {}

  // The next iteration for the singular value of J starts anew.
  void forget_direction() { series().set_weakest_direction({}); }
  // The expansion of the reference. It is that of the present step unless a kernel has made that one.
  Expansion<N>& series() { return reference_.series(); }
  const Expansion<N>& series() const { return reference_.series(); }
  N coefficient(std::size_t j, int k) const { return series().coefficient(j, k); }
  N quadrature(std::size_t i, int k) const { return series().quadrature(i)[k]; }
  static constexpr bool constant_quadrature(std::size_t) { return false; }  // as far as is known
  // The integral of quadrature i over h.
  W integral(std::size_t i, const W& h) const { return reference_.integral(i, h); }
  const Expansion<W>& point(const MotionTrack<N>&, bool) const { return point_; }
  // Computes state and leading derivatives at h beyond the point of the present expansion.
  void state_at(const MotionTrack<N>&, const W& h, std::vector<W>& state, std::vector<W>& leading) const;

 private:
  double shrink_;
  ReferenceExpansion<N> reference_;
  Expansion<W> point_;
};

// Makes expansions by a kernel that agree with those of the reference to round-off. The reference makes the expansions
// of careful steps, the first one and ever fewer later ones, which measure how regular J is, and all those for which
// the kernel does not serve.
class GuardedExpander {
 public:
  using N = double;
  using W = Wider<double>;
  GuardedExpander(const Program& program, const std::vector<double>& parameters, const std::vector<W>& wide_parameters,
                  const StepSettings& settings, int order);

  void accelerate(KernelExpansion kernel) { kernel_ = std::move(kernel); }
  const std::vector<W>& wide_parameters() const { return wide_parameters_; }
  // Sets the parameters of the reference; the parameters of a kernel's lane are set in the kernel.
  void set_parameters(const std::vector<double>& parameters, const std::vector<W>& wide_parameters);

  KernelExpansion* kernel() { return maker_ == Maker::kernel ? &*kernel_ : nullptr; }
  const KernelExpansion* kernel() const { return maker_ == Maker::kernel ? &*kernel_ : nullptr; }
  bool accelerated() const { return kernel_.has_value(); }
  // True if state_at() returns states that satisfy the constraints as well as projected states do: velocities computed
  // from quasi-velocities satisfy them if no constraint restricts positions.
  bool foretells_consistent_states() const { return kernel() && kernel()->mapped() && kernel()->without_positions(); }
  bool alone() const { return !kernel_ || kernel_->alone(); }
  bool suspected() const { return kernel_ && kernel_->suspected(); }
  std::size_t expansions_by_kernel() const { return by_kernel_; }
  int order() const { return order_; }
  void restart();
  void reset();

  void begin(MotionTrack<double>& track, const std::vector<W>& guess, bool again);
  void expand_kernel() {
    if (awaits_kernel_) kernel_->expand();
  }
  bool end_by_kernel(MotionTrack<double>& track);
  double drift_of_kernel() const { return kernel_->drift(); }
  // Makes the reference repeat an expansion that the kernel has made.
  void refuse_kernel(MotionTrack<double>& track) {
    kernel_->take_back_as_begun(track);
    if (kernel_->mapped()) track.now.leading = kernel_->leading();
    maker_ = Maker::reference;
    --by_kernel_;
  }
  // goes_on_with_kernel(): true if an expansion is awaited of the kernel that has made the expansion before.
  // end_at_once(): like end_by_kernel() if nothing in the expansion needs a closer look; otherwise it returns false and
  // changes nothing.
  bool goes_on_with_kernel() const { return awaits_kernel_ && kernel() && kernel()->may_be_ordinary(); }
  bool end_at_once(MotionTrack<double>& track);
  // Updates the track after ordinary steps that were made in the kernel: up to the expansion that is awaited, or past
  // it.
  void follow(MotionTrack<double>& track, const OrdinaryCourse& course);
  Outcome prepare(MotionTrack<double>& track, const std::vector<W>& guess);
  Outcome solve(MotionTrack<double>& track, const std::vector<W>& guess) {
    return reference().solve(track.now, guess, solution());
  }
  const MissedConstraint<double>& missed() { return reference().missed(); }
  Outcome extend() { return reference().extend(); }
  void cut_to(const MotionState<double>& m, const std::vector<W>& leading) {
    reference().cut_to(m, leading, solution());
  }
  double reach() const { return kernel() ? kernel()->reach() : reference().reach(shrink_); }

  void show_deciding() {
    if (kernel()) kernel()->show_deciding(series());
  }
  void look_for_turns(double horizon) {
    if (kernel()) kernel()->look_for_turns(horizon);
  }

  bool advance(MotionTrack<double>& track, const W& h) {
    return kernel() ? kernel()->follow(track, h) : reference().advance(track.now, h, solution());
  }

  MotionState<double> motion(const MotionTrack<double>& track, bool expanded) const;
  StepperState<double> begun(const MotionTrack<double>& track) const;
  void take_back(MotionTrack<double>& track, bool expanded) {
    if (kernel_) kernel_->take_back(track, expanded);
  }
  void round_state() {
    if (kernel_) kernel_->round_state();
  }

  // The next iteration for the singular value of J starts anew.
  void forget_direction() {
    if (reference_) reference_->series().set_weakest_direction({});
  }
  Expansion<double>& series() { return reference().series(); }
  const Expansion<double>& series() const { return reference().series(); }
  double coefficient(std::size_t j, int k) const {
    return kernel() ? kernel()->coefficient(j, k) : series().coefficient(j, k);
  }
  double quadrature(std::size_t i, int k) const {
    return kernel() ? kernel()->quadrature(i, k) : series().quadrature(i)[k];
  }
  bool constant_quadrature(std::size_t i) const { return kernel() && kernel()->constant_quadrature(i); }
  W integral(std::size_t i, const W& h) const {
    return kernel() ? W(kernel()->integral(i)) : reference().integral(i, h);
  }
  const Expansion<W>& point(const MotionTrack<double>& track, bool values) const;
  void state_at(const MotionTrack<double>& track, const W& h, std::vector<W>& state, std::vector<W>& leading) const;
  // Like state_at(), but a state in the unknowns of the kernel is returned as `own`; either `state` or `own` stays
  // empty.
  void own_state_at(const MotionTrack<double>& track, const W& h, std::vector<W>& state, std::vector<W>& own,
                    std::vector<W>& leading) const;

 private:
  bool kernel_serves(const StepRecord<double>& record) const;

  // Both are made when they are first needed: a motion that the kernel makes alone needs neither.
  ReferenceExpansion<double>& reference() const;
  Expansion<W>& solution() const;

  const Program* program_;
  std::vector<double> parameters_;
  std::vector<W> wide_parameters_;
  int order_;
  bool measure_;
  double shrink_;
  mutable std::unique_ptr<ReferenceExpansion<double>> reference_;
  std::optional<KernelExpansion> kernel_;
  enum class Maker : std::uint8_t { reference, kernel };
  Maker maker_ = Maker::reference;  // of the present expansion
  bool awaits_kernel_ = false;      // an expansion is begun, and the kernel's result has not been looked at yet
  std::size_t by_kernel_ = 0;
  // The solution at the point of the present expansion. After an expansion by the kernel it is computed when it is
  // first asked for.
  mutable std::unique_ptr<Expansion<W>> solution_;
  enum class Known : std::uint8_t { nothing, solution, values };
  mutable Known known_ = Known::values;  // which parts of solution_ are known
};

namespace expander_of {
template <Number N>
struct Type {
  using type = ReferenceExpander<N>;
};
template <>
struct Type<double> {
  using type = GuardedExpander;
};
}  // namespace expander_of
template <Number N>
using Expander = typename expander_of::Type<N>::type;

extern template class ReferenceExpander<long double>;
extern template class ReferenceExpander<Quad>;
extern template class ReferenceExpander<Multi>;

}  // namespace anholon
