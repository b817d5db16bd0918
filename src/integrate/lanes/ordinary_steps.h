// Makes ordinary steps (stepper_aim.cpp) of the motions in all lanes of a kernel together. The steppers of the motions
// take no part as long as no lane needs a closer look, and are then told which steps were made. Each step has the bits
// of the step that the stepper would have made; if that is not sure, the stepper makes it.
#pragma once
#include <limits>
#include <span>
#include <vector>

#include "integrate/end_check.h"
#include "integrate/stepper.h"

namespace anholon {

class OrdinarySteps {
 public:
  using W = Wider<double>;
  explicit OrdinarySteps(std::shared_ptr<Kernel> kernel, const StepSettings& settings);

  // `stepper`: nullptr if the lane is free. `end`: where the motion ends. The caller has to look at a step that comes
  // to the time `until`, which is not beyond the end, and at the last one of `most` steps.
  struct Motion {
    Stepper<double>* stepper = nullptr;
    W end{0}, until{0};
    std::size_t most = std::numeric_limits<std::size_t>::max();
  };
  // Makes ordinary steps. Call it after begin_step() of all steppers and Kernel::begin(), with a motion for each lane.
  // Returns true if all steppers are aimed and the kernel is at the end of their steps, so that the steppers have to
  // look; false if the steppers have to be aimed.
  bool run(std::span<const Motion> motions);

 private:
  // The motion in a lane, and the step that is aimed.
  struct Lane {
    OrdinaryCourse course;
    double until = 0, left = 0;  // `left`: an upper bound of what was left to the end
    double sign = 0;             // of the direction of time; 0 if the lane is free
    double to = 0, length = 0;
    Pivots pivots;
  };
  bool take(std::span<const Motion> motions);
  bool aim();
  bool aim(Lane& lane, int at) const;
  void go();
  bool arrives() const;
  void finish();
  void tell(std::span<const Motion> motions, bool aimed);

  std::shared_ptr<Kernel> kernel_;
  StepSettings settings_;
  EndCheck<double> check_;
  std::vector<Lane> lanes_;
  std::size_t made_ = 0, most_ = 0;  // steps of this run
};

}  // namespace anholon
