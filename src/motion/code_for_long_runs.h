// Machine code for a kernel that has been at work for a while, made beside the motion; its bits are the same.
#pragma once
#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>

#include "kernel/kernel.h"

namespace anholon {

class CodeForLongRuns {
 public:
  CodeForLongRuns() = default;
  // Does not wait for a compilation on its way: it comes to its end with the process, see below.
  ~CodeForLongRuns();
  CodeForLongRuns(const CodeForLongRuns&) = delete;
  CodeForLongRuns& operator=(const CodeForLongRuns&) = delete;

  // Asked at every step, by one thread at a time: begins a compilation for this plan if what is left to do takes longer
  // than that. `at`: how far the work has come on its way to `end`; `spent`: the seconds that it took since the first
  // request, if these are not all that have passed.
  void step(const std::shared_ptr<const KernelPlan>& plan, double at, double end, int lanes = 1,
            std::optional<double> spent = {});
  // So many steps followed the last request, which stands for one of them.
  void count(std::size_t steps) { asked_ += steps > 1 ? steps - 1 : 0; }

 private:
  struct Compilation {
    std::shared_ptr<const KernelPlan> plan;
    std::shared_ptr<std::atomic<bool>> done;
    std::thread thread;
  };
  void leave();

  Compilation compilation_;
  struct First {
    std::chrono::steady_clock::time_point when = std::chrono::steady_clock::now();
    double at;
  };
  std::optional<First> first_;  // when it was asked first, and where
  std::size_t asked_ = 0;       // since the clock was read
};

// Whether compilations are on their way that nobody asks for any more. exit() waits for them; a program that has
// nothing left to do may leave by std::_Exit (what is kept on disk is written under another name first).
bool compiling_for_nobody();

}  // namespace anholon
