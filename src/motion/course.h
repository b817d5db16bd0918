// A motion by the method that was asked for, or by the one that takes the fewest operations (theory: methods).
//
// Taylor's motion (motion.h) is the main line: it starts, and it goes where another method cannot: to the end of a
// table, to a mass that vanishes, past a singular point, to another elimination. What another method costs is found on
// a stretch of the motion itself and counted in operations, never measured in time, so the same motion always takes the
// same course.
#pragma once
#include "integrate/states/state_rate.h"
#include "motion/code_for_long_runs.h"
#include "model/methods.h"
#include "motion/motion.h"

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
class Course {
 public:
  using W = Wider<N>;

  Course(Workspace& scenario, const StepSettings& settings, Method asked, std::vector<Expr> quadratures, int stages);

  Outcome start(const StateChoice& choice) { return motion_.start(choice); }
  Outcome step(const W& end);
  // The solution anywhere in the last step.
  Outcome at(const W& t);
  const Expansion<W>& point() const { return by_other_ ? *point_ : motion_.point(); }
  // Where the last step began, its derivatives.
  const Expansion<W>& begun() const { return by_other_ ? *begun_ : motion_.stepper().point(); }

  // Taylor's, for what only it has; where the last step was another method's, it is somewhere before.
  Motion<N>& taylor() { return motion_; }
  const Motion<N>& taylor() const { return motion_; }
  bool by_taylor() const { return !by_other_; }

  W time() const;
  W before() const;
  const std::vector<W>& integrals() const;
  std::size_t steps() const;
  int order() const;
  W worst_constraint() const;
  // As of a stepper, of all methods.
  const N& smallest_sigma() const;
  const W& smallest_sigma_time() const;
  std::size_t weakest_unknown() const;
  const N& first_sigma() const { return motion_.stepper().first_sigma(); }
  MethodReport report() const;

 private:
  void choose(const W& end);
  bool try_bdf(const W& end);
  std::string percent() const { return number_text(100 * ratio_, 2) + " % of Taylor's operations on the same stretch"; }
  bool pays(Method method, std::size_t steps, double factor, const W& end);
  void make_plans();
  std::unique_ptr<StateStepper> make(Method method);
  MotionPoint here() const;
  std::optional<Outcome> step_by_other(const W& end);
  bool passed_singular_point();
  Outcome hand_over(const MotionPoint& p);
  bool slower_than_taylor();
  void look();
  double spent(StateStepper& stepper) const;
  void turn(Method to, std::string why);

  const Scenario& s_;
  StepSettings settings_;
  Motion<N> motion_;
  std::vector<Guard> guards_;
  int stages_;
  bool free_ = false;               // to choose a method
  Method wanted_ = Method::taylor;  // by which the motion goes on
  std::unique_ptr<StateStepper> other_;
  const Program* planned_ = nullptr;
  std::shared_ptr<const KernelPlan> plan_;  // of its rates
  double expansion_work_ = 0;               // of Taylor's
  CodeForLongRuns code_;
  bool by_other_ = false;                     // the last step
  std::size_t rescues_ = 0, taylor_for_ = 0;  // how often Taylor had to help; the steps it still makes
  std::optional<Expansion<W>> point_, begun_;
  std::optional<Expansion<N>> look_;
  W worst_constraint_{0}, smallest_sigma_t_{0};
  N smallest_sigma_{1};
  std::size_t weakest_ = 0;
  double least_health_ = 1;
  bool suspected_ = false;  // J may be singular close by
  // Taylor's last steps, and when it is asked next whether another method pays.
  std::vector<W> times_;
  static constexpr std::size_t kStretch = 256;  // steps that are remembered
  std::size_t next_kinks_ = 128, next_stiff_ = 2048;
  double pace_ = 0,
         ratio_ = 0;  // operations for a unit of time by Taylor where it was left; what the trial took of them
  double window_t_ = 0, window_spent_ = 0;
  std::size_t window_steps_ = 0;
  MethodReport report_;
};

extern template class Course<double>;
extern template class Course<long double>;
extern template class Course<Quad>;
extern template class Course<Multi>;

// Why no other method can make the motion of these equations, or nothing.
std::string only_taylor(const Model& model, const Program& program);

}  // namespace anholon
