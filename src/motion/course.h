// A motion by the method that was asked for, or by the one that takes the fewest operations (theory: methods).
//
// Taylor's motion (motion.h) is the main line: it starts, and it goes where another method cannot: to the end of a
// table, to a mass that vanishes, past a singular point, to another elimination. What another method costs is found on
// a stretch of the motion itself and counted in operations, never measured in time, so the same motion always takes the
// same course. Numbers wider than double have Taylor's method alone; Course<N> names the class of each number type.
#pragma once
#include "motion/code_for_long_runs.h"
#include "motion/method_choice.h"
#include "motion/state_motion.h"

namespace anholon {

struct MethodReport {
  Method asked = Method::automatic, last = Method::taylor;
  struct Turn {  // where the method changed
    double t = 0;
    Method to = Method::taylor;
    std::string why;
  };
  std::vector<Turn> turns;
  std::size_t taylor_steps = 0, expansions = 0;
  std::size_t steps = 0, refused = 0, evaluations = 0;  // of the other method
  std::size_t trials = 0, trial_evaluations = 0;        // that led to nothing, or were made again
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
  // A stretch of steps.
  Outcome steps(const W& end, Stretch<W>& stretch) { return motion_.steps(end, stretch); }
  // The solution anywhere in the last step.
  Outcome at(const W& t) { return motion_.at(t); }
  const Expansion<W>& point() const { return motion_.point(); }
  // Where the last step began, its derivatives.
  const Expansion<W>& begun() const { return motion_.stepper().point(); }
  W begun_coordinate(std::size_t a) const { return motion_.stepper().begun_value(a); }

  // Taylor's motion; where the last step was another method's, it lags behind.
  Motion<N>& taylor() { return motion_; }
  const Motion<N>& taylor() const { return motion_; }
  bool by_taylor() const { return true; }  // the last step

  W time() const { return motion_.stepper().time(); }
  W before() const { return motion_.stepper().before(); }  // the time where the last step began
  const std::vector<W>& integrals() const { return motion_.stepper().integrals(); }
  std::size_t steps() const { return motion_.stepper().steps(); }
  int order() const { return motion_.stepper().order(); }
  W worst_constraint() const { return motion_.stepper().worst_constraint(); }
  // Of the scaled system Jacobian: its smallest singular value so far, when it was met, the unknown that it determined
  // least there; the first one.
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

// The same in doubles, where other methods may take over stretches of the motion.
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
  // What a looser tolerance would win, told once; else empty.
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
  std::unique_ptr<StateMotion> other_;  // the stretch by another method that is under way
  bool by_other_ = false;               // the last step
  StateRecord met_;                     // by other methods
  CodeForLongRuns code_;
  std::size_t rescues_ = 0, taylor_for_ = 0;  // how often Taylor had to help; the steps it still makes
  MethodReport report_;                       // `last` is the method by which the motion goes on
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

// The reason why no other method can make the motion of these equations; else an empty string.
std::string only_taylor(const Model& model, const Program& program);

}  // namespace anholon
