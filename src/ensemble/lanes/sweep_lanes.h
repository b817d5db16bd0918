// Chooses the number of lanes in which a sweep computes its cases, and makes the machine code for these lanes.
//
// A sweep begins with the number of lanes whose machine code is ready at once (translated_at_first). A long sweep also
// tries the greatest number of lanes of this machine, whose code takes longer to make, and continues with the number
// that takes less time for a case. The bits of a case do not depend on the number of lanes.
#pragma once
#include <array>
#include <atomic>
#include <mutex>

#include "kernel/kernel.h"
#include "motion/code_for_long_runs.h"

namespace anholon {

class SweepLanes {
 public:
  // The number of lanes of one group of cases, and whether their code was ready when the group began.
  struct Turn {
    int lanes = 1;
    bool compiled = false;
  };

  // `cases`: of the sweep; few cases are computed in one lane. `threads`: of the sweep; 0: as many as the machine has.
  // `narrow`: the first number of lanes; `wide`: the greatest one of a tier of this machine.
  SweepLanes(std::size_t cases, std::size_t threads)
      : SweepLanes(cases, threads, lanes_at_first(), tiers().back().lanes) {}
  SweepLanes(std::size_t cases, std::size_t threads, int narrow, int wide);

  // Returns the number of lanes for the group of cases that begins with case `next`, and begins compilations that pay.
  // Any thread may call it.
  Turn begin(const std::shared_ptr<const KernelPlan>& plan, std::size_t next);
  // Notes how many seconds of its thread a group of this turn took.
  void end(const Turn& turn, std::size_t cases, double seconds);

 private:
  // A number of lanes, and the time of the cases in it.
  struct Width {
    int lanes = 1;
    CodeForLongRuns code{};
    std::size_t cases = 0, groups = 0;
    double seconds = 0;

    bool measured() const;
    double seconds_of_case() const { return seconds / static_cast<double>(cases); }
  };
  enum class Phase : std::uint8_t { narrow, compiling_wide, measuring_wide, decided };
  void look(const std::shared_ptr<const KernelPlan>& plan, std::size_t next);
  void step(Width& width, const std::shared_ptr<const KernelPlan>& plan, std::size_t next);
  bool wide_may_pay(const KernelPlan& plan, std::size_t next) const;

  const std::size_t cases_;
  const bool compiles_beside_;  // on a core that computes no cases
  std::mutex lock_;
  std::array<Width, 2> widths_;  // narrow, wide
  Phase phase_;
  std::atomic<std::size_t> now_{0};  // the index of the present width
};

}  // namespace anholon
