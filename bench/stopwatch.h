// The time of a piece of work on a machine with other users: the smaller of wall time and the thread's CPU time. CPU
// time excludes the work of others in between; wall time is read without a system call.
#pragma once
#include <algorithm>
#include <ctime>

class Stopwatch {
 public:
  double seconds() const {
    const double wall = now(CLOCK_MONOTONIC) - wall_;
    return std::min(wall, now(CLOCK_THREAD_CPUTIME_ID) - core_);
  }
  double wall_seconds() const { return now(CLOCK_MONOTONIC) - wall_; }

 private:
  static double now(clockid_t clock) {
    timespec t{};
    clock_gettime(clock, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  }
  double core_ = now(CLOCK_THREAD_CPUTIME_ID), wall_ = now(CLOCK_MONOTONIC);
};

// Returns the median; reorders the times.
template <class Times>
double median(Times& times) {
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  return *middle;
}
