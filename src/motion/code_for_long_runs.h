// Machine code for a kernel that has been at work for a while, made beside the motion; its bits are the same.
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
  // Does not wait for a compilation on its way: it comes to its end with the process, see below.
  ~CodeForLongRuns();
  CodeForLongRuns(const CodeForLongRuns&) = delete;
  CodeForLongRuns& operator=(const CodeForLongRuns&) = delete;

  // Asked at every step, by one thread at a time: begins a compilation for this plan if what is left to do takes longer
  // than that. `at`: how far the work has come on its way to `end`; `spent`: the seconds that it took until now, if these
  // are not all that have passed. The first code is made quickly.
  void step(const std::shared_ptr<const KernelPlan>& plan, double at, double end, int lanes = 1,
            std::optional<double> spent = {});
  // About the seconds until quick code for a plan is there.
  static double seconds_to_make(const KernelPlan& plan, int lanes);
  // The rest takes so many times as long, because the motion is computed once more.
  void expect(double times) { times_ = times; }
  // Tells how many steps followed the last request, which stands for one of them.
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
  // How far the work had come after so many seconds of a clock that is always the same one.
  struct Point {
    double seconds, at;
  };
  static Point point(double at, std::optional<double> spent, int lanes);

  std::optional<Point> first_, since_quick_;  // of the first request, and of the first with code that was made quickly
  std::size_t asked_ = 0;                     // since the clock was read
  double times_ = 1;
};

// Whether compilations are on their way that nobody asks for any more. exit() waits for them; a program that has
// nothing left to do may leave by std::_Exit (what is kept on disk is written under another name first).
bool compiling_for_nobody();

}  // namespace anholon
