// Computations without partial results, in threads of their own, which Ctrl-C ends.
#pragma once
#include <memory>

#include "core.h"

namespace anholon::python {

// The data that a computation and the thread that waits for it share.
template <class F>
struct Interruptible {
  explicit Interruptible(F f) : compute(std::move(f)) {}
  F compute;
  std::mutex mutex;
  std::condition_variable changed;
  std::optional<decltype(std::declval<F&>()())> value;
  std::exception_ptr failed;
  std::atomic<bool> asked_to_stop{false};
  bool done = false;
  const bool at_the_end = Ending::begun();  // true at the end of the process, which then does not stop the computation

  // Runs the computation in its thread.
  void run() {
    const StopRequest request([this] { return asked_to_stop || (!at_the_end && Ending::begun()); });
    try {
      value.emplace(compute());
    } catch (...) {
      failed = std::current_exception();
    }
  }
  void tell() {
    const std::lock_guard lock(mutex);
    done = true;
    changed.notify_one();
  }
  // Waits for a moment without the interpreter's lock; returns true if the computation has ended.
  bool wait() {
    constexpr std::chrono::milliseconds kPause{20};
    const Unlocked without_lock;
    std::unique_lock lock(mutex);
    return changed.wait_for(lock, kPause, [&] { return done; });
  }
};

// Returns f(), computed without the interpreter's lock. f owns all that it reads. Throws nb::python_error if a handler
// of signals raises, as that of Ctrl-C does: at most 20 ms after the signal the computation is asked to stop, and this
// function waits until it has stopped. If another signal comes meanwhile, the function returns without waiting for the
// thread.
template <class F>
auto interruptible(F f) {
  if (Ending::elsewhere()) Ending::stay();
  const auto shared = std::make_shared<Interruptible<F>>(std::move(f));
  // The thread uses tables of the library as long as it is Running.
  std::thread thread([own = shared, running = std::make_unique<Running>()]() mutable {
    own->run();
    own->tell();
    own.reset();
    running.reset();
  });
  while (!shared->wait())
    if (PyErr_CheckSignals() != 0) {
      const nb::python_error raised;
      shared->asked_to_stop = true;
      while (!shared->wait())
        if (PyErr_CheckSignals() != 0) {
          PyErr_Clear();
          thread.detach();
          throw raised;
        }
      thread.join();
      throw raised;
    }
  thread.join();
  if (shared->failed) std::rethrow_exception(shared->failed);
  return *std::move(shared->value);
}

// Calls f(), which may read arrays of the caller, without the interpreter's lock and in a thread of its own. Throws
// nb::python_error if a handler of signals raises; f, which checks for stop requests often, has ended before.
template <class F>
void stoppable(const F& f) {
  if (Ending::elsewhere()) Ending::stay();
  const auto whole = [&] { return f(), true; };
  Interruptible shared(std::cref(whole));
  std::thread thread([&, running = std::make_unique<Running>()]() mutable {
    shared.run();
    shared.tell();
    running.reset();
  });
  std::optional<nb::python_error> raised;
  while (!shared.wait())
    if (PyErr_CheckSignals() != 0) {
      raised.emplace();
      shared.asked_to_stop = true;
    }
  thread.join();
  if (raised) throw nb::python_error(*raised);
  if (shared.failed) std::rethrow_exception(shared.failed);
}

}  // namespace anholon::python
