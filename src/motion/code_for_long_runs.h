// Makes machine code for a kernel that has been at work for a while, beside the motion; the code gives the same bits.
#pragma once
#include <atomic>
#include <memory>
#include <optional>
#include <thread>

#include "kernel/kernel.h"

namespace anholon {

class CodeForLongRuns {
 public:
  CodeForLongRuns() = default;
  // Does not wait for a running compilation, which ends at the latest with the process (compiling_for_nobody).
  ~CodeForLongRuns();
  CodeForLongRuns(const CodeForLongRuns&) = delete;
  CodeForLongRuns& operator=(const CodeForLongRuns&) = delete;

  // Call it at every step, from one thread at a time. It begins a compilation for this plan if the rest of the work
  // would take longer than the compilation. `at`: how far the work has come on its way to `end`; `spent`: the seconds
  // of the work so far, if these are not all that have passed. The first code is made quickly.
  void step(const std::shared_ptr<const KernelPlan>& plan, double at, double end, int lanes = 1,
            std::optional<double> spent = {});
  // Estimates the seconds in which quick code for a plan is made.
  static double seconds_to_make(const KernelPlan& plan, int lanes);
  // The rest of the work takes `times` as long, because the motion is computed once more.
  void expect(double times) { times_ = times; }
  // Notes that `steps` steps were made after the last call of step(), which itself counts as one.
  void count(std::size_t steps) { asked_ += steps > 1 ? steps - 1 : 0; }

 private:
  struct Compilation {
    std::shared_ptr<const KernelPlan> plan;
    CodeEffort effort = CodeEffort::full;
    std::shared_ptr<std::atomic<bool>> done;
    std::thread thread;
  };
  void leave();
  void begin(const std::shared_ptr<const KernelPlan>& plan, int lanes, CodeEffort effort);

  Compilation compilation_;
  // The progress `at` of the work after so many seconds of the clock of point().
  struct Point {
    double seconds, at;
  };
  static Point point(double at, std::optional<double> spent, int lanes);

  std::optional<Point> first_, since_quick_;  // at the first call, and at the first call with quick code
  std::size_t asked_ = 0;                     // steps since the clock was read
  double times_ = 1;
};

// True if compilations are running whose objects are destroyed. exit() waits for them; a program that has nothing left
// to do may leave by std::_Exit (cached code is written under another name first).
bool compiling_for_nobody();

}  // namespace anholon
