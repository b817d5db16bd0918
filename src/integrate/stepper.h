// The motion by Taylor steps. Each step, in the order of stepper.cpp:
//
//   begin   an expansion is begun where the motion is
//   expand  by a kernel or the reference (expander.h): projected on all hidden constraints, solved for the leading
//           derivatives, all coefficients; how far the series reach (step_control.h) is the horizon
//   aim     the end of the step: at the horizon or the caller's end; before J becomes singular (regularity.h), past a
//           kink, at an event, and where the equations hold that the series foretell (step_end.h)
//   finish  the state goes there, summed with its round-off carried along; so do the integrals
//
// The series of the last step stay: they are the dense output. Phase says how far a step is.
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

  // Starts at a consistent state; `leading` is a first guess and names the branch. What the stepper did before leaves
  // no trace. Without the kernel the first expansion is the reference's, as it is in lanes.
  Outcome start(const W& t, const std::vector<W>& state, const std::vector<W>& leading = {}, bool kernel = true);
  // As start(), but the first step makes the expansion.
  void place(const W& t, const std::vector<W>& state, const std::vector<W>& leading = {});
  // Goes on where another stepper for the same unknowns is, with its sums and counts.
  Outcome take_over(const Stepper& other);
  // As take_over(), but restart() makes the expansion.
  void adopt(const Stepper& other);
  // Goes on from another state at the same time (after `adopt`, if another stepper was there): an event has changed it.
  // It is projected on the constraints by least change. `kernel`: as for start().
  Outcome restart(const std::vector<W>& state, bool kernel = true);
  // Goes on where an expansion of another stepper was begun, or of this one.
  Outcome resume(const StepperState<N>& begun);

  // Makes the expansions by a kernel wherever that serves: not where its pivots have become small. If multipliers are
  // watched, the kernel has the unknowns of the motion: others know none. Before the start.
  void accelerate(std::shared_ptr<const KernelPlan> plan)
    requires std::same_as<N, double>;
  // As above, by one lane of a kernel that others use, too; its parameters are those of this motion. Steps are then
  // made side by side, see below.
  void accelerate(std::shared_ptr<Kernel> kernel, int lane)
    requires std::same_as<N, double>;
  bool accelerated() const { return expander_.accelerated(); }
  // Other parameters of the equations, before place(), start() or restart(); those of a kernel's lane are set there.
  void set_parameters(const std::vector<N>& parameters, const std::vector<W>& wide_parameters)
    requires std::same_as<N, double>
  {
    expander_.set_parameters(parameters, wide_parameters);
    look_.set_parameters(parameters);
  }
  // Series to be watched for changes of sign; a step ends where one does that asks for it.
  void watch(std::vector<WatchedSeries> series);

  // One step towards `end`, at most up to it.
  Outcome step(const W& end) { return make_step(end) ? Outcome{} : trouble(); }
  // A stretch of steps: one at least. It also ends with a step after which the caller has something to do: that fired
  // an event, or met a kink. Between its steps the state is rounded (round_state).
  Outcome steps(const W& end, Stretch<W>& stretch);
  // Its parts, for steppers in the lanes of one kernel: after `begin_step` of all of them the kernel is to be expanded,
  // after `aim` of all it is to advance and to start the next expansion, again as long as one of them then asks for
  // another end (`look_at_end`), and nothing else may happen to it in between. Where one fails, `trouble` is what there
  // was, asked for once.
  [[nodiscard]] bool begin_step();
  [[nodiscard]] bool aim(const W& end);
  [[nodiscard]] EndOfStep look_at_end(const W& end);
  [[nodiscard]] bool finish_step();
  // After `begin_step`: the motion from which ordinary steps can be made in the lanes of the kernel
  // (lanes/ordinary_steps.h); nullopt if the next step may be none. Whoever makes them says so to `follow`.
  std::optional<OrdinaryCourse> ordinary_course() const
    requires std::same_as<N, double>;
  void follow(const OrdinaryCourse& course)
    requires std::same_as<N, double>;
  // Whether the last of these steps ended where the caller has set the end. The motion is still in its lane, where the
  // others carry it on with the next expansion: until then it can be read by `at`, or taken out.
  bool arrived() const { return phase_ == Phase::advanced && !ordinary_ && end_.arrives(); }
  Outcome trouble() { return std::exchange(trouble_, {}); }
  // Rounds the state as it is rounded when it is taken out of a kernel's lane and put back.
  void round_state() { expander_.round_state(); }
  // Takes the motion out of a kernel's lane. The next expansion puts it back.
  void leave_kernel() { expander_.take_back(track_, expanded()); }

  // Where the motion is; first guesses of what leads it, out of the last step's polynomial.
  const W& time() const { return track_.now.t; }
  std::vector<W> state() const { return motion().state; }
  std::vector<W> leading() const { return motion().leading; }
  // Where the present expansion was begun: the start of the last step, or of the next one if that is expanded already. A
  // step cut short by its end is thus repeated in full by whoever resumes.
  StepperState<N> begun() const { return expander_.begun(track_); }
  const W& before() const { return before_; }                    // the time where the last step began
  const std::vector<Fired<N>>& fired() const { return fired_; }  // in the last step, in order
  // Integrals of the quadratures since the start.
  const std::vector<W>& integrals() const { return track_.now.integrals; }

  // The solution where the last step began, or at the start: projected and solved. Its derivatives; with `values` those
  // of all formulas, too. Where a formula has no value there, the leading derivatives are those right after it.
  const Expansion<W>& point(bool values = false) const { return expander_.point(track_, values); }
  // … and anywhere in the last step, in an expansion of the caller; on request without what leads the state. Where the
  // motion stops as a formula has no value, the leading derivatives are not numbers.
  Outcome at(const W& t, Expansion<W>& point, bool leading = true) const;
  // The state anywhere in the last step by its polynomials, not projected, and a guess of the leading derivatives.
  void foretell(const W& t, std::vector<W>& state, std::vector<W>& leading) const {
    expander_.state_at(track_, t - before_, state, leading);
  }
  // As above. If a kernel with unknowns of its own has made the step, `own` gets the state in these, and `state` stays
  // empty; else `own` stays empty.
  void foretell(const W& t, std::vector<W>& state, std::vector<W>& own, std::vector<W>& leading) const
    requires std::same_as<N, double>
  {
    expander_.own_state_at(track_, t - before_, state, own, leading);
  }
  // The dense output in the numbers of the expansion, for a rough measure. Kernels in unknowns of their own know no
  // multipliers.
  N coefficient(std::size_t j, int k) const { return expander_.coefficient(j, k); }
  // Whether the last step's polynomials end with the leading derivatives, as formulas have no derivatives there.
  bool one_sided() const { return one_sided_.has_value(); }
  // Unknown j where the last step began.
  W begun_value(std::size_t j) const { return convert<W>(expander_.coefficient(j, 0)); }
  // The dense output of the last step as it is: x_j is the sum of dense(j, k) (t - before())^k, k = 0..degree(j).
  // Coefficients up to that of the leading derivative come from the wider point.
  std::size_t unknowns() const { return program_->unknowns(); }
  int degree(std::size_t j) const { return order_ - 1 + program_->d[j]; }
  W dense(std::size_t j, int k) const {
    return k <= program_->d[j] ? point().coefficient(j, k) : convert<W>(expander_.coefficient(j, k));
  }
  // Quadrature i as a polynomial in t - before() over the last step: its value there.
  W quadrature(std::size_t i, const W& dt) const;
  // … and its coefficient of order k < order().
  N quadrature_coefficient(std::size_t i, int k) const { return expander_.quadrature(i, k); }
  // Whether it is known to be the same at all times.
  bool constant_quadrature(std::size_t i) const { return expander_.constant_quadrature(i); }

  // The watched series that alone makes the present step short; nullopt if the motion itself does, or nothing.
  std::optional<std::size_t> shortened_by() const;

  int order() const { return order_; }
  std::size_t steps() const { return record().steps; }
  std::size_t kinks() const { return end_.kinks(); }      // steps that one has cut short
  std::size_t expansions() const { return expansions_; }  // made so far
  std::size_t expansions_by_kernel() const { return expander_.expansions_by_kernel(); }
  const W& worst_constraint() const { return record().worst_constraint; }
  const W& worst_equation() const { return record().worst_equation; }
  // Where the scaled system Jacobian was least regular; its smallest singular value at the first expansion.
  const LeastRegular<N>& least_regular() const { return record().least_regular; }
  const N& first_sigma() const { return record().first_sigma; }

 private:
  enum class Phase : std::uint8_t {
    placed,    // the motion is somewhere, without an expansion there
    begun,     // an expansion is begun, perhaps by a kernel
    expanded,  // it is made
    aimed,     // the end of the step is chosen
    advanced,  // the step is made; the expansion where it began is that of the dense output
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
  bool ordinary_ = false;  // the step that is aimed: it ends there
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
