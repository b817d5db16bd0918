// Integrates stiff motions by BDF: by CVODE (sundials.h), with steps that end on all hidden constraints (theory:
// methods).
#pragma once
#include <optional>

#include "integrate/states/sundials.h"
#include "integrate/states/time_stops.h"
#include "integrate/step_budget.h"

namespace anholon {

class Bdf final : public StateStepper {
 public:
  Bdf(StateRate rate, const StepSettings& settings);

  const char* title() const override { return "BDF"; }
  // REQUIRES: it has not been called before.
  Outcome start(const MotionPoint& from, long double end) override;
  Outcome step(long double end) override;
  Outcome at(long double t, MotionPoint& point) override;
  std::size_t refused() const override { return motion_ ? motion_->refused() : 0; }
  StateRate& rate() override { return motion_ ? motion_->rate() : *rate_; }
  double more_work() const override;

 private:
  void put(MotionPoint& point) const;
  void aim_beyond(double t);

  std::optional<StateRate> rate_;
  std::optional<Sundials> motion_;
  StepSettings settings_;
  StepPaces paces_;
  TimeStops stops_;
  std::optional<TimeStops::Stop> stop_;  // the next one
  double end_ = 0;
};

}  // namespace anholon
