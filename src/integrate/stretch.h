// Several steps that a caller requests at once: the conditions that end them, and the times at which they ended. A
// caller that has something to do after every step requests one step; other callers request many, which follow each
// other in one loop.
#pragma once
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <span>
#include <vector>

#include "numeric/number.h"

namespace anholon {

// An unknown that has to stay near a value.
struct Kept {
  std::size_t unknown;
  double value;
};

template <Number W>
struct Stretch {
  // The stretch ends after so many steps, and with the first step that comes to `until`; nullptr: the end of the
  // motion.
  std::size_t most = 1;
  const W* until = nullptr;
  // The stretch ends with a step that begins where one of these unknowns is `margin` or more away from its value.
  std::span<const Kept> kept = {};
  double margin = 0;

  // The times where the steps end, and the greatest absolute value of the first integral where they begin.
  std::vector<W> times = {};
  W greatest_integral{0};

  void restart() {
    times.clear();
    greatest_integral = W(0);
  }
  void limit(std::size_t steps) {
    if (steps < most) most = steps;
  }
};

// Chooses the number of steps that are requested at once, so that code which follows a motion (to stop it, to write
// rows, progress or a saved run) runs often enough. The number has no influence on the steps. Many stretches end early,
// because a row is due; therefore the clock is read after as many steps as one full stretch has.
class StretchPace {
 public:
  using Clock = std::chrono::steady_clock;

  // `made`: the number of steps of the stretch before.
  std::size_t steps(std::size_t made) {
    constexpr std::size_t kMost = 64;
    constexpr std::chrono::microseconds kShort(500), kLong(5000);
    made_ += made;
    if (made_ < steps_) return steps_;
    made_ = 0;
    const Clock::time_point now = Clock::now();
    if (now - read_ < kShort) steps_ = std::min(kMost, 2 * steps_);
    if (now - read_ > kLong) steps_ = 1;
    read_ = now;
    return steps_;
  }
  // The time when the clock was read last.
  Clock::time_point read() const { return read_; }

 private:
  std::size_t steps_ = 1, made_ = 0;
  Clock::time_point read_ = Clock::now();
};

// Stretches one after the other, of the lengths that StretchPace gives.
template <Number W>
struct PacedStretch : Stretch<W> {
  // Begins the next stretch, which ends with the first step that comes to `time`. `each_step`: something is due after
  // every step.
  void begin(bool each_step, const W* time) {
    const std::size_t steps = pace.steps(this->times.size());
    this->restart();
    this->most = each_step ? 1 : steps;
    this->until = time;
  }
  StretchPace pace;
};

}  // namespace anholon
