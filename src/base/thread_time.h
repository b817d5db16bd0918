// Processor time of a thread: the time in which it waits for a core does not count.
#pragma once
#include <ctime>

namespace anholon {

// Returns the seconds of processor time that the calling thread has used.
inline double seconds_of_this_thread() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace anholon
