// Integrates a motion by Taylor steps. Each step, in the order of stepper.cpp:
//
//   begin   an expansion is begun where the motion is
// expand  by a kernel or the reference (expander.h): projected on all hidden constraints, solved for the leading
// derivatives, all coefficients; the distance over which the series are good (step_control.h) is the horizon
//   aim     the end of the step: at the horizon or the caller's end; before J becomes singular (regularity.h), past a
//           kink, at an event, and where the equations hold that the series foretell (step_end.h)
//   finish  the state goes there, summed with its round-off carried along; so do the integrals
//
// The series of the last step are kept: they are the dense output. Phase tells how far a step is.
#pragma once
#include "integrate/one_sided_start.h"
#include "integrate/regularity.h"
#include "integrate/step_budget.h"
#include "integrate/step_end.h"
#include "integrate/stretch.h"

namespace anholon {

enum class EndOfStep : std::uint8_t { good, elsewhere, failed };

template <Number N>
class Stepper {
 public:
  using W = Wider<N>;

  Stepper(const Program& program, const std::vector<N>& parameters, const std::vector<W>& wide_parameters,
          const StepSettings& settings);

  // Starts at a consistent state; `leading` is a first guess and selects the branch. Nothing that the stepper did
  // before has an influence. Without `kernel` the reference makes the first expansion, as it does in lanes.
  Outcome start(const W& t, const std::vector<W>& state, const std::vector<W>& leading = {}, bool kernel = true);
  // Like start(), but the first step makes the expansion.
  void place(const W& t, const std::vector<W>& state, const std::vector<W>& leading = {});
  // Continues the motion of another stepper for the same unknowns, with its sums and counts.
  Outcome take_over(const Stepper& other);
  // Like take_over(), but restart() makes the expansion.
  void adopt(const Stepper& other);
  // Continues from another state at the same time, which an event has changed (after `adopt`, if another stepper was
  // there). The state is projected on the constraints by the least change. `kernel`: as for start().
  Outcome restart(const std::vector<W>& state, bool kernel = true);
  // Continues from where an expansion of another stepper, or of this one, was begun.
  Outcome resume(const StepperState<N>& begun);

  // Makes the expansions by a kernel unless its pivots have become small. If multipliers are watched, the kernel has to
  // have the unknowns of the motion, because other kernels have no multipliers. Call it before the start.
  void accelerate(std::shared_ptr<const KernelPlan> plan)
    requires std::same_as<N, double>;
  // Like accelerate(plan), but in one lane of a kernel that has other motions in its other lanes; the lane's parameters
  // are those of this motion. Steps are then made side by side, by the functions below.
  void accelerate(std::shared_ptr<Kernel> kernel, int lane)
    requires std::same_as<N, double>;
  bool accelerated() const { return expander_.accelerated(); }
  // Sets other parameters of the equations. Call it before place(), start() or restart(); the parameters of a kernel's
  // lane are set in the kernel.
  void set_parameters(const std::vector<N>& parameters, const std::vector<W>& wide_parameters)
    requires std::same_as<N, double>
  {
    expander_.set_parameters(parameters, wide_parameters);
    look_.set_parameters(parameters);
  }
  // Sets the series that are watched for changes of sign; a step ends at a change of those that ask for it.
  void watch(std::vector<WatchedSeries> series);

  // Makes one step towards `end`, at most up to it.
  Outcome step(const W& end) { return make_step(end) ? Outcome{} : trouble(); }
  // Makes a stretch of steps, at least one. The stretch also ends with a step that fired an event or met a kink, so
  // that the caller can react. Between its steps the state is rounded (round_state).
  Outcome steps(const W& end, Stretch<W>& stretch);
  // The parts of a step, for steppers in the lanes of one kernel: after `begin_step` of all steppers the kernel has to
  // be expanded; after `aim` of all it has to advance and start the next expansion, and again as long as a stepper asks
  // for another end (`look_at_end`). Nothing else may happen to the kernel in between. If a part fails, `trouble`
  // returns the reason once.
  [[nodiscard]] bool begin_step();
  [[nodiscard]] bool aim(const W& end);
  [[nodiscard]] EndOfStep look_at_end(const W& end);
  [[nodiscard]] bool finish_step();
  // After `begin_step`, returns the motion from which ordinary steps can be made in the lanes of the kernel
  // (lanes/ordinary_steps.h); nullopt if the next step may not be ordinary. After these steps, `follow` has to be
  // called.
  std::optional<OrdinaryCourse> ordinary_course() const
    requires std::same_as<N, double>;
  void follow(const OrdinaryCourse& course)
    requires std::same_as<N, double>;
  // True if the last of these steps ended where the caller has set the end. The motion is still in its lane, where the
  // next expansion will carry it on: until then it can be read by `at`, or taken out.
  bool arrived() const { return phase_ == Phase::advanced && !ordinary_ && end_.arrives(); }
  Outcome trouble() { return std::exchange(trouble_, {}); }
  // Rounds the state as taking it out of a kernel's lane and putting it back does.
  void round_state() { expander_.round_state(); }
  // Takes the motion out of a kernel's lane. The next expansion puts it back.
  void leave_kernel() { expander_.take_back(track_, expanded()); }

  // The time, the state, and first guesses of the leading derivatives from the last step's polynomial.
  const W& time() const { return track_.now.t; }
  std::vector<W> state() const { return motion().state; }
  std::vector<W> leading() const { return motion().leading; }
  // The state where the present expansion was begun: at the start of the last step, or of the next one if its expansion
  // is already made. A run that resumes there repeats a step that was cut short by its end in full.
  StepperState<N> begun() const { return expander_.begun(track_); }
  const W& before() const { return before_; }                    // the time where the last step began
  const std::vector<Fired<N>>& fired() const { return fired_; }  // in the last step, in order
  // Integrals of the quadratures since the start.
  const std::vector<W>& integrals() const { return track_.now.integrals; }

  // The solution where the last step began, or at the start: projected and solved, with its derivatives; with `values`
  // also with all formulas. If a formula has no value there, the leading derivatives are those right after it.
  const Expansion<W>& point(bool values = false) const { return expander_.point(track_, values); }
  // The solution at any time of the last step, in an expansion of the caller; on request without the leading
  // derivatives. If the motion stops because a formula has no value, the leading derivatives are not numbers.
  Outcome at(const W& t, Expansion<W>& point, bool leading = true) const;
  // The state at any time of the last step by its polynomials, not projected, and a guess of the leading derivatives.
  void foretell(const W& t, std::vector<W>& state, std::vector<W>& leading) const {
    expander_.state_at(track_, t - before_, state, leading);
  }
  // Like foretell(), but if a kernel with unknowns of its own has made the step, `own` gets the state in those unknowns
  // and `state` stays empty; otherwise `own` stays empty.
  void foretell(const W& t, std::vector<W>& state, std::vector<W>& own, std::vector<W>& leading) const
    requires std::same_as<N, double>
  {
    expander_.own_state_at(track_, t - before_, state, own, leading);
  }
  // A coefficient of the dense output in the numbers of the expansion, for a rough measure. Kernels with unknowns of
  // their own have no multipliers.
  N coefficient(std::size_t j, int k) const { return expander_.coefficient(j, k); }
  // True if the last step's polynomials end with the leading derivatives, because formulas have no derivatives there.
  bool one_sided() const { return one_sided_.has_value(); }
  // The value of unknown j where the last step began.
  W begun_value(std::size_t j) const { return convert<W>(expander_.coefficient(j, 0)); }
  // The dense output of the last step: x_j is the sum of dense(j, k) (t - before())^k, k = 0..degree(j). Coefficients
  // up to that of the leading derivative come from the wider point.
  std::size_t unknowns() const { return program_->unknowns(); }
  int degree(std::size_t j) const { return order_ - 1 + program_->d[j]; }
  W dense(std::size_t j, int k) const {
    return k <= program_->d[j] ? point().coefficient(j, k) : convert<W>(expander_.coefficient(j, k));
  }
  // The value of quadrature i at before() + dt, by its polynomial over the last step.
  W quadrature(std::size_t i, const W& dt) const;
  // The coefficient of order k < order() of this polynomial.
  N quadrature_coefficient(std::size_t i, int k) const { return expander_.quadrature(i, k); }
  // True if the quadrature is known to be constant.
  bool constant_quadrature(std::size_t i) const { return expander_.constant_quadrature(i); }

  // The watched series that alone makes the present step short; nullopt if there is none.
  std::optional<std::size_t> shortened_by() const;

  int order() const { return order_; }
  std::size_t steps() const { return record().steps; }
  std::size_t kinks() const { return end_.kinks(); }      // steps that a kink has cut short
  std::size_t expansions() const { return expansions_; }  // made so far
  std::size_t expansions_by_kernel() const { return expander_.expansions_by_kernel(); }
  const W& worst_constraint() const { return record().worst_constraint; }
  const W& worst_equation() const { return record().worst_equation; }
  // The point where the scaled system Jacobian was least regular; its smallest singular value at the first expansion.
  const LeastRegular<N>& least_regular() const { return record().least_regular; }
  const N& first_sigma() const { return record().first_sigma; }

 private:
  enum class Phase : std::uint8_t {
    placed,    // the motion has a state, without an expansion there
    begun,     // an expansion is begun, perhaps by a kernel
    expanded,  // the expansion is made
    aimed,     // the end of the step is chosen
    advanced,  // the step is made; its expansion is that of the dense output
  };

  bool make_step(const W& end);
  bool stays(const Stretch<W>& stretch) const;
  Outcome expand();
  void begin_expansion();
  bool end_expansion();
  Outcome expand_here(const std::vector<W>& guess);
  bool end_by_kernel();
  Outcome expand_by_reference(const std::vector<W>& guess);
  Outcome expand_regularly(const std::vector<W>& guess);
  Outcome expand_one_sided(Outcome fault);
  bool take_one_sided(const W& h);
  void limit_by_quadratures();
  template <class Series>
  void limit_by_quadratures(const Series& series);
  void limit_by_events();
  void limit_by_kinks();
  void read_events();
  void watch_kinks();
  void expand_again(const StepperState<N>& last);
  Outcome look_back();

  void note_length(const W& to);
  void finish_at(const W& to);

  bool may_be_ordinary() const
    requires std::same_as<N, double>;
  bool aim_ordinarily(const W& end);
  bool aim_freely(const W& end);
  void aim_at(const W& to);
  void drop_aim();
  bool aim_again(KernelExpansion& kernel, const W& end);
  bool aim_by_reference(KernelExpansion& kernel, const W& end);
  bool aim_with_care(const W& end);
  bool aim_one_sided(const W& left);
  bool shorten_at_singular_point(W& h, const W& floor);
  void shorten_at_event(W& h, const std::optional<N>& kink);
  bool out_of_reach(const W& h, const W& left);

  bool fail(Outcome why);
  bool expanded() const { return phase_ == Phase::expanded || phase_ == Phase::aimed; }
  W horizon() const { return end_.horizon(horizon_); }
  MotionState<N> motion() const { return expander_.motion(track_, expanded()); }
  StepRecord<N>& record() { return track_.now.record; }
  const StepRecord<N>& record() const { return track_.now.record; }
  PresentStep<N> present() { return {track_, expander_, look_}; }

  const Program* program_;
  StepSettings settings_;
  int order_;
  Tolerance tolerance_;
  Phase phase_ = Phase::placed;
  MotionTrack<N> track_;
  StepPaces paces_;
  W before_{0};
  bool ordinary_ = false;  // the aimed step is ordinary: it ends at ordinary_end_
  W ordinary_end_{0};
  Expander<N> expander_;
  std::optional<OneSidedStart<N>> one_sided_;  // if the present expansion ends with the leading derivatives
  std::size_t expansions_ = 0;
  N horizon_{0};  // of the present expansion
  LookAhead<N> look_;
  std::vector<std::uint32_t> kink_arguments_;  // slots that decide which functions hold
  JacobianGuard<N> guard_;
  StepEnd<N> end_;
  EventWatch<N> events_{{}};
  std::vector<Fired<N>> fired_;
  Outcome trouble_;
};

extern template class Stepper<double>;
extern template class Stepper<long double>;
extern template class Stepper<Quad>;
extern template class Stepper<Multi>;

}  // namespace anholon
