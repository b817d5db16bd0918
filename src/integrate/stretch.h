// Several steps that a caller asks for at once: the conditions that end them, and the times at which they ended. A caller
// that has something to do after every step asks for one step; other callers ask for many, which follow each other in
// one loop.
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
  // The stretch ends after so many steps, and with the first step that comes to `until`; none: the end of the motion.
  std::size_t most = 1;
  const W* until = nullptr;
  // It ends with a step that begins where one of these is `margin` or more away.
  std::span<const Kept> kept = {};
  double margin = 0;

  // The times where its steps end; the greatest absolute value of the first integral where they begin.
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

// How many steps are asked for at once, so that whoever waits for a motion (to stop it, for its rows, its progress, a
// saved run) is asked often enough. That has no influence on the steps. Many stretches end early, because a row is due;
// the clock is read after as many steps as are asked for.
class StretchPace {
 public:
  using Clock = std::chrono::steady_clock;

  // `made`: the steps of the stretch before.
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
  // When the clock was read last.
  Clock::time_point read() const { return read_; }

 private:
  std::size_t steps_ = 1, made_ = 0;
  Clock::time_point read_ = Clock::now();
};

// Stretches one after the other, of the lengths that StretchPace gives.
template <Number W>
struct PacedStretch : Stretch<W> {
  // The next one, which ends with the first step that comes to `time`. `each_step`: something is due after every step.
  void begin(bool each_step, const W* time) {
    const std::size_t steps = pace.steps(this->times.size());
    this->restart();
    this->most = each_step ? 1 : steps;
    this->until = time;
  }
  StretchPace pace;
};

}  // namespace anholon
