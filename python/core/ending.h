// The end of the process while threads of the user or of the library compute.
//
// At the end the interpreter ends every thread that asks for its lock, by unwinding a stack with C++ frames, which ends
// the process. The computations are therefore asked to stop before, and threads that wait for them block, without the
// lock.
#pragma once
#include <atomic>
#include <chrono>
#include <cstddef>

#include <nanobind/nanobind.h>

namespace anholon::python {

class Ending {
 public:
  // begun() is true if the process has begun to end; elsewhere() is true if another thread than this one ends it.
  static bool begun() { return begun_; }
  static bool elsewhere();
  // Serves the functions that are called at the end, with the interpreter's lock held: waits until no thread of the
  // library computes and none is without the lock. Prints a message if that takes long; Ctrl-C then ends the process.
  static void wait();
  // Is called in the child of a fork, which has one thread.
  static void forget_other_threads();
  // Blocks this thread for good, without the lock. REQUIRES: elsewhere(), with the lock held.
  [[noreturn]] static void stay();

 private:
  friend class Running;
  friend class Unlocked;
  static inline std::atomic<bool> begun_{false};
  static inline std::atomic<int> running_{0}, unlocked_{0};
};

// Exists as long as a thread of the library computes. It is made with the interpreter's lock held, so that the end of
// the process knows of the thread.
class Running {
 public:
  Running() { ++Ending::running_; }
  ~Running() { --Ending::running_; }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  static int count() { return Ending::running_; }
};

// Exists while this thread runs without the interpreter's lock. At the end of the process the thread blocks within the
// constructor or the destructor.
class Unlocked {
 public:
  Unlocked();
  ~Unlocked();
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

 private:
  PyThreadState* state_;
};

}  // namespace anholon::python
