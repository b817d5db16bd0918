// A motion in progress: its steps, the events between them, and the choices on which its equations depend.
//
// A motion goes through legs. Forms without multipliers divide by pivots that may become small during the motion; the
// equations are then made again with other dependent coordinates, and the motion continues from the same state (theory:
// elimination). If constraints are redundant, those that take part may become dependent while one that is left out
// becomes independent: they are chosen again, too (theory: dae-view, redundant constraints). Each such leg is derived
// in a workspace of its own, a copy of the workspace in which the motion was made: its bits depend on the state where
// it begins, and not on the legs before it.
#pragma once
#include <algorithm>
#include <functional>
#include <optional>

#include "integrate/stepper.h"
#include "motion/code_for_long_runs.h"
#include "motion/representation.h"
#include "motion/saved.h"
#include "motion/set_by_event.h"
#include "numeric/told_time.h"
#include "setup/nearest_state.h"
#include "setup/outputs/choice_watch.h"
#include "setup/scenario.h"

namespace anholon {

// An event that fired.
template <Number W>
struct Occurrence {
  std::size_t event = 0;  // of the model
  W t{0};
  std::vector<ChangeByEvent<W>> changes;
  W correction{0};  // the largest change by which constraints made consistent what was set
};

// Computes the solution at a place that was foretold (integrate/stepper.h), in `point`; `beyond`: with the orders
// beyond the leading derivatives.
template <Number W>
Outcome settle_at(Expansion<W>& point, const Start<W>& place, bool beyond) {
  point.load(place.t, place.state, place.leading);
  Outcome o = point.prepare();
  if (o.ok()) o = point.project();
  if (o.ok()) o = point.solve();
  if (o.ok() && beyond) o = point.extend();
  tell_time(o, to_double(place.t));
  return o;
}

// The plans that a motion by a kernel has found, for further motions of the same equations with the same orders.
struct MotionPlans {
  std::shared_ptr<const KernelPlan> plan, unmapped_plan;  // nullptr without a kernel
  Writing writing = Writing::derived;
  WritingEffort effort = WritingEffort::at_once;
};

// The hint for an event whose formula has no value at some point of the motion.
inline constexpr const char* kEventWithoutValue = "write a formula that has a value all along the motion and the same "
                                                  "zeros, such as x - 2 for log(x - 1), or end the "
                                                  "motion before";

// watched_formulas(): the formulas that a motion watches, those of events, then those of bounds. watched_series(): how
// it watches them, if they are the quadratures of its program from `first` on.
std::vector<Expr> watched_formulas(const Model& model);
std::vector<WatchedSeries> watched_series(const Scenario& scenario, std::size_t first);
// True if multipliers occur in the watched formulas: a kernel with unknowns of its own has no multipliers.
bool watches_multipliers(const Model& model);

// Returns the time up to which the last step describes the motion: its end, or, if events there set something, a time
// beyond it by the round-off of an event's time, so that a row at the event shows the motion before it.
template <Number N>
Wider<N> told_until(const Model& model, const Stepper<N>& stepper) {
  using W = Wider<N>;
  constexpr int kRoundoffs = 4;
  const W end = stepper.time();
  const auto any = [&](auto is) {
    return std::any_of(stepper.fired().begin(), stepper.fired().end(),
                       [&](const Fired<N>& f) { return f.series < model.events.size() && is(model.events[f.series]); });
  };
  if (!any([](const Event& e) { return !e.set.empty(); }) || any([](const Event& e) { return e.stop; })) return end;
  const W beyond = convert<W>(unit_roundoff<N>()) * W(kRoundoffs) * abs(end);
  return end < stepper.before() ? W(end - beyond) : W(end + beyond);
}

// N: the number type of the Taylor coefficients; W: that of the state and of everything written.
template <Number N>
class Motion {
 public:
  using W = Wider<N>;

  // `quadratures`: expressions that are integrated or watched along the motion. `stages`: the number of orders beyond
  // the leading derivatives in the points.
  Motion(Workspace& scenario, const StepSettings& settings, std::vector<Expr> quadratures, int stages);

  MotionPlans plans() const { return {leg_->plan, leg_->unmapped_plan, leg_->writing, effort_}; }
  // Makes the motion use these plans. Call it before the start.
  void use(const MotionPlans& plans) { given_ = plans, effort_ = plans.effort; }
  // The motion will be computed once more, with somewhat shorter steps.
  void expect_second_run() { code_.expect(kBothRuns); }
  // Makes start() begin with a state that differs from the consistent one by some round-offs.
  void start_in_other_digits(bool other) { other_digits_ = other; }
  Outcome start(const StateChoice& choice);
  // The state at the start of the whole motion.
  const Start<W>& start_state() const { return start_; }
  // save() writes everything that resume() needs to continue from the last expansion, with the bits of a run that never
  // stopped.
  void save(SavedRun& to) const;
  Outcome resume(const StateChoice& choice, const SavedRun& from);
  // Computes the solution at a place that was foretold (integrate/stepper.h), in `point()`: by the equations of the
  // leg, or by those of another choice if that of the leg is bad there.
  Outcome settle_at(const Start<W>& place) {
    choose_beside(place);
    return anholon::settle_at(shown().point, place, stages_ > 0);
  }
  // Makes a stretch of steps towards `end`, or one step, with another elimination if the present one fails or its
  // pivots have become small.
  Outcome steps(const W& end, Stretch<W>& stretch);
  Outcome step(const W& end) {
    Stretch<W> one;
    return steps(end, one);
  }
  // Computes the solution at any time of the last step, with the orders beyond the leading derivatives, if there are
  // any.
  Outcome at(const W& t);
  const Expansion<W>& point() const { return shown().point; }
  // fired(): true if events fired in the last step. settle() applies what they set; then the motion continues from the
  // end of the step. `goes_on` becomes false if an event ends the motion. It fails if the motion leaves a table, or if
  // there is no consistent state near the one that was set.
  bool fired() const { return !leg_->stepper.fired().empty(); }
  Outcome settle(std::vector<Occurrence<W>>& occurrences, bool& goes_on);
  // After settle() has failed, goes back to the equations in which the state before the events can be shown.
  void go_back() {
    if (before_events_.leg) leg_ = std::move(before_events_.leg), set_modes(before_events_.modes);
  }
  // Fails if the formula of an event has no value at the start, or the argument of a table lies outside of it there or
  // leaves it.
  Outcome within_bounds(bool forward);
  // The value of an event's formula at the start.
  double at_start(std::size_t event) const {
    return to_double(leg_->stepper.quadrature(quadratures_.size() + event, W(0)));
  }

  const Stepper<N>& stepper() const { return leg_->stepper; }
  const Program& program() const { return leg_->program; }
  const std::vector<W>& parameters() const { return parameters_; }
  const std::vector<W>& start_parameters() const { return start_parameters_; }
  // The number of choices of other dependent coordinates or other independent constraints during the motion.
  std::size_t eliminations() const { return choices_.taken; }
  // For another method (motion/course.h): the plan of the kernel, or nullptr; whether the choices should be made anew
  // at a point; Taylor steps from where the other method is.
  const std::shared_ptr<const KernelPlan>& plan() const { return leg_->plan; }
  // The cheapest plan in the motion's own unknowns, for other methods.
  const std::shared_ptr<const KernelPlan>& unmapped_plan() const { return leg_->unmapped_plan; }
  bool pivot_is_small(const Expansion<W>& at) { return pivot_is_below(kSmallPivot, at); }
  Outcome go_on(const StepperState<N>& from) { return leg_->stepper.resume(from); }

 private:
  bool leaves(std::size_t bound, bool met, bool forward) const;
  // A stretch of the motion with one choice of dependent coordinates and of independent constraints: its system and its
  // stepper.
  struct Leg {
    // `own`: the workspace of the system and the elimination; nullptr if it is that of the motion.
    Leg(const Motion& motion, std::shared_ptr<Workspace> own, Elimination by, System of, Structure structured);
    std::shared_ptr<Workspace> own;
    Elimination elimination;
    System system;
    Structure structure;
    std::vector<Expr> quadratures;  // the quadratures of the motion, of events and of bounds, in the workspace
    Program program;
    Stepper<N> stepper;
    Expansion<W> point, present;
    std::shared_ptr<const KernelPlan> plan;  // of the stepper's kernel, if it has one
    std::shared_ptr<const KernelPlan> unmapped_plan;
    Writing writing = Writing::derived;
    std::vector<Representation> at_once;     // the representations found without effort
    std::unique_ptr<ChoiceWatch<W>> pivots;  // null if there is nothing to choose
  };

  // The choices during the motion: a resumed run repeats the last one that was taken.
  struct Choices {
    struct Choice {
      InitialState<double> here;
      bool taken = false;
    };
    std::vector<Choice> list;
    std::size_t taken = 0;
    std::vector<double> pivots;  // their values when the present choice was made
    // The choices before the last expansion.
    struct Mark {
      std::size_t choices = 0;
      std::vector<double> pivots;
    };
    Mark now() const { return {list.size(), pivots}; }
    Mark begun;
  };
  // A leg with another choice, for a point at which the choice of the leg is bad.
  struct Beside {
    std::unique_ptr<Leg> leg;
    bool shown = false;
  };

  Leg& shown() const { return beside_.shown ? *beside_.leg : *leg_; }
  Workspace& workspace(const Leg& leg) const { return leg.own ? *leg.own : s_; }
  void watch_pivots(Leg& leg) const;
  const Expansion<W>& present();
  InitialState<double> here(const Expansion<W>& point) const;
  bool pivot_is_below(double share, const Expansion<W>& at);
  void choose_beside(const Start<W>& place);
  void accelerate(Leg& leg) const;
  static void take(const MotionPlans& plans, Leg& leg);
  ToRepresent to_represent(const Leg& leg, std::shared_ptr<const KernelPlan> derived) const;
  const Representation& best(const std::vector<Representation>& list) const {
    return settings_.multipliers || watches_multipliers(*s_.model) ? cheapest_unmapped(list) : cheapest(list);
  }
  void write_anew();
  std::unique_ptr<Leg> same_leg() const;
  std::unique_ptr<Leg> derived_at(const InitialState<double>& here) const;
  bool choose_again();
  std::size_t levels() const {
    return 2 + static_cast<std::size_t>(s_.routh ? std::max(0, largest_order(s_, s_.structure.d) - 1) : 0);
  }

  static constexpr double kBothRuns = 2.25;
  // Shares of a pivot's size when the choice was made. Below kSmallPivot the choice is made anew; a solution inside a
  // step whose pivot is below kBadPivot is found by another choice.
  static constexpr double kSmallPivot = 0.4, kBadPivot = 0.1;

  Workspace& s_;
  std::unique_ptr<const Workspace> base_;  // a copy of `s_` when the motion was made, if legs may be derived from it
  StepSettings settings_;
  void set_modes(const std::vector<W>& parameters);
  const SetByEvent& set_by(std::size_t event);
  Outcome to_nearest(std::vector<W>& state);
  std::vector<Expr> with_watched(Workspace& in) const;
  bool watches() const { return !s_.model->events.empty() || !s_.model->bounds.empty(); }

  std::vector<Expr> quadratures_;
  int stages_;
  std::vector<W> start_parameters_, parameters_;  // they differ in modes
  std::vector<N> narrow_parameters_;
  // The numbers that the events have set; with constraints, also the solver that makes the set state consistent.
  struct EventEffects {
    std::vector<std::optional<SetByEvent>> sets;
    std::optional<NearestState<W>> nearest;
  };
  EventEffects effects_;
  Start<W> start_;
  std::vector<W> begun_parameters_;  // the parameters of the last expansion
  std::unique_ptr<Leg> leg_;
  // If events that could not be applied have set modes: the leg and the parameters before them.
  struct {
    std::unique_ptr<Leg> leg;
    std::vector<W> modes;
  } before_events_;
  Beside beside_;
  bool stepped_ = false, other_digits_ = false;
  std::optional<MotionPlans> given_;
  Choices choices_;
  CodeForLongRuns code_;
  WritingEffort effort_ = WritingEffort::at_once;  // the effort of the present writing of the kernel's equations
};

extern template class Motion<double>;
extern template class Motion<long double>;
extern template class Motion<Quad>;
extern template class Motion<Multi>;

// Explains the stop of a motion: a mass that vanishes, two solutions that meet, a multiplier that grows without bound.
template <Number N>
void explain_stop(Workspace& scenario, const Motion<N>& motion, Outcome& outcome);

}  // namespace anholon
