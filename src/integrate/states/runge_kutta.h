// Integrates motions by Dormand and Prince's explicit Runge-Kutta method of order 8 (dormand_prince.h), for tolerances
// so loose, or forces so little smooth, that Taylor's polynomials do not pay.
//
// The state is kept in wider numbers than its rates and summed with its round-off carried along; every step ends on all
// hidden constraints, by the first evaluation of the next step. Step sizes follow the error estimate by a PI controller
// (theory: methods).
#pragma once
#include "integrate/states/dormand_prince.h"
#include "integrate/states/state_rate.h"
#include "integrate/states/time_stops.h"
#include "integrate/step_budget.h"

namespace anholon {

class RungeKutta final : public StateStepper {
 public:
  RungeKutta(StateRate rate, const StepSettings& settings);

  const char* title() const override { return "Runge-Kutta 8"; }
  Outcome start(const MotionPoint& from, long double end) override;
  Outcome step(long double end) override;
  // The point is computed by a step of its own.
  Outcome at(long double t, MotionPoint& point) override;
  std::size_t refused() const override { return refused_; }
  StateRate& rate() override { return rate_; }

 private:
  using Stages = std::array<std::vector<double>, dormand_prince::kStages>;

  Outcome may_go_on(long double left);
  void pass(const TimeStops::Stop& kink);
  Outcome first_rate();
  double first_step(double direction);
  Outcome stages(const MotionPoint& from, double h);
  Outcome whole(double h);
  bool turned() const;
  Outcome cut_at_kink(double& h);
  double error(double h);
  // The round-offs of the sums of a state and of the integrals.
  struct RoundOffs {
    std::vector<long double> state, integrals;
  };
  void advance(MotionPoint& to, RoundOffs& carry, double h);

  StateRate rate_;
  StepSettings settings_;
  double tolerance_;
  Stages k_;                  // rates of the state, then the quadratures
  std::vector<double> here_;  // the first stage at now()
  std::vector<double> start_, y_, change_, sizes_, e5_, e3_;
  std::vector<std::pair<double, double>> most_;
  RoundOffs carry_;
  StepPaces paces_;
  TimeStops stops_;
  std::optional<TimeStops::Stop> passed_;  // the kink of the time that ended the last step
  double h_ = 0, error_before_ = 1;
  std::size_t refused_ = 0;
  struct Kinks {  // the sides at now()
    std::vector<int> sides;
    std::vector<double> arguments;
    int short_steps = 0;  // steps in a row that a kink cut at their very start
  };
  Kinks kinks_;
};

}  // namespace anholon
