// A motion by the method that the user asked for, or by the one that takes the fewest operations (theory: methods).
//
// Taylor's motion (motion.h) is the main line: it starts, and it takes over where another method cannot go on: at the
// end of a table, at a mass that vanishes, past a singular point, with another elimination. The cost of another method
// is found on a stretch of the motion itself and counted in operations, never measured in time, so the same motion
// always takes the same course. Numbers wider than double have Taylor's method alone; Course<N> names the class of each
// number type.
#pragma once
#include "motion/code_for_long_runs.h"
#include "motion/method_choice.h"
#include "motion/state_motion.h"

namespace anholon {

struct MethodReport {
  Method asked = Method::automatic, last = Method::taylor;
  struct Turn {  // a change of the method
    double t = 0;
    Method to = Method::taylor;
    std::string why;
  };
  std::vector<Turn> turns;
  std::size_t taylor_steps = 0, expansions = 0;
  std::size_t steps = 0, refused = 0, evaluations = 0;  // those of the other method
  std::size_t trials = 0, trial_evaluations = 0;        // trials that were given up, or whose steps were made again
  bool differs_from_taylor() const { return steps > 0 || trials > 0 || !turns.empty(); }
};

template <Number N>
class TaylorCourse {
 public:
  using W = Wider<N>;

  TaylorCourse(Workspace& scenario, const StepSettings& settings, Method asked, const std::vector<Expr>& quadratures,
               int stages)
      : motion_(scenario, settings, quadratures, stages), asked_(asked) {}

  Outcome start(const StateChoice& choice) { return motion_.start(choice); }
  // Makes a stretch of steps.
  Outcome steps(const W& end, Stretch<W>& stretch) { return motion_.steps(end, stretch); }
  // Computes the solution at any time of the last step.
  Outcome at(const W& t) { return motion_.at(t); }
  const Expansion<W>& point() const { return motion_.point(); }
  // The solution where the last step began, with its derivatives.
  const Expansion<W>& begun() const { return motion_.stepper().point(); }
  W begun_coordinate(std::size_t a) const { return motion_.stepper().begun_value(a); }

  // Taylor's motion; it lags behind if another method has made the last step.
  Motion<N>& taylor() { return motion_; }
  const Motion<N>& taylor() const { return motion_; }
  bool by_taylor() const { return true; }  // true if Taylor's method has made the last step

  W time() const { return motion_.stepper().time(); }
  W before() const { return motion_.stepper().before(); }  // the time where the last step began
  const std::vector<W>& integrals() const { return motion_.stepper().integrals(); }
  std::size_t steps() const { return motion_.stepper().steps(); }
  int order() const { return motion_.stepper().order(); }
  W worst_constraint() const { return motion_.stepper().worst_constraint(); }
  // The smallest singular value of the scaled system Jacobian so far, its time, the unknown that was determined least
  // there; and the first singular value.
  const N& smallest_sigma() const { return motion_.stepper().least_regular().sigma; }
  const W& smallest_sigma_time() const { return motion_.stepper().least_regular().t; }
  std::size_t weakest_unknown() const { return motion_.stepper().least_regular().unknown; }
  const N& first_sigma() const { return motion_.stepper().first_sigma(); }
  MethodReport report() const;
  static std::string take_advice() { return {}; }

 private:
  Motion<N> motion_;
  Method asked_;
};

// A course in doubles, in which other methods may take over stretches of the motion.
class MethodCourse {
 public:
  using W = Wider<double>;

  MethodCourse(Workspace& scenario, const StepSettings& settings, Method asked, const std::vector<Expr>& quadratures,
               int stages);

  Outcome start(const StateChoice& choice) { return motion_.start(choice); }
  Outcome steps(const W& end, Stretch<W>& stretch);
  Outcome at(const W& t) { return by_other_ ? other_->at(t) : motion_.at(t); }
  const Expansion<W>& point() const { return by_other_ ? other_->point() : motion_.point(); }
  const Expansion<W>& begun() const { return by_other_ ? other_->begun() : motion_.stepper().point(); }
  W begun_coordinate(std::size_t a) const {
    return by_other_ ? other_->begun().derivative(a, 0) : motion_.stepper().begun_value(a);
  }

  Motion<double>& taylor() { return motion_; }
  const Motion<double>& taylor() const { return motion_; }
  bool by_taylor() const { return !by_other_; }

  W time() const { return by_other_ ? other_->stepper().now().t : motion_.stepper().time(); }
  W before() const { return by_other_ ? other_->stepper().before().t : motion_.stepper().before(); }
  const std::vector<W>& integrals() const {
    return by_other_ ? other_->stepper().now().integrals : motion_.stepper().integrals();
  }
  std::size_t steps() const { return motion_.stepper().steps() + report_.steps; }
  int order() const;
  W worst_constraint() const;
  double smallest_sigma() const { return least_regular().sigma; }
  W smallest_sigma_time() const { return least_regular().t; }
  std::size_t weakest_unknown() const { return least_regular().unknown; }
  double first_sigma() const { return motion_.stepper().first_sigma(); }
  MethodReport report() const;
  // Tells once what a looser tolerance would save; empty if there is nothing to tell.
  std::string take_advice() { return choice_ ? choice_->take_advice() : std::string(); }

 private:
  const LeastRegular<double>& least_regular() const;
  Outcome steps_by_taylor(const W& end, Stretch<W>& stretch);
  std::optional<Outcome> step_by_other(const W& end);
  Outcome go_on_from(const MotionPoint& p);
  std::optional<Outcome> help_from(const MotionPoint& p, std::size_t steps);
  std::optional<Outcome> return_to_taylor(std::string why);
  void turn(MethodChoice::Turn to);

  Motion<double> motion_;
  const Model& model_;
  StepSettings settings_;
  int stages_;
  StateSteppers steppers_;
  std::optional<MethodChoice> choice_;  // if the method is free
  std::unique_ptr<StateMotion> other_;  // the present stretch by another method
  bool by_other_ = false;               // another method has made the last step
  StateRecord met_;                     // the record of other methods
  CodeForLongRuns code_;
  std::size_t rescues_ = 0, taylor_for_ = 0;  // the rescues by Taylor's method; the steps that it still makes
  MethodReport report_;                       // `last` is the method that continues the motion
};

namespace course_of {
template <Number N>
struct Type {
  using type = TaylorCourse<N>;
};
template <>
struct Type<double> {
  using type = MethodCourse;
};
}  // namespace course_of
template <Number N>
using Course = typename course_of::Type<N>::type;

extern template class TaylorCourse<long double>;
extern template class TaylorCourse<Quad>;
extern template class TaylorCourse<Multi>;

// Returns the reason why no other method can make the motion of these equations; an empty string if one can.
std::string only_taylor(const Model& model, const Program& program);

}  // namespace anholon
