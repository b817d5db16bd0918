// Computations that keep nothing, in threads of their own: Ctrl-C ends them.
#pragma once
#include <memory>

#include "core.h"

namespace anholon::python {

// The threads whose computation nobody waits for any longer. The process may not end before they do, since they use
// tables of the library. All functions are called with the interpreter's lock held.
class Abandoned {
 public:
  static Abandoned& threads();
  void add(std::thread thread, std::shared_ptr<const std::atomic<bool>> done);
  // For the end of the process: waits for all; a second Ctrl-C ends the process.
  void wait();

 private:
  struct One {
    std::thread thread;
    std::shared_ptr<const std::atomic<bool>> done;
  };
  void forget_finished();
  std::vector<One> list_;
};

// What a computation and the thread that waits for it share.
template <class F>
struct Interruptible {
  explicit Interruptible(F f) : compute(std::move(f)) {}
  F compute;
  std::mutex mutex;
  std::condition_variable changed;
  std::optional<decltype(std::declval<F&>()())> value;
  std::exception_ptr failed;
  std::atomic<bool> asked_to_stop{false}, done{false};

  // In the thread of the computation.
  void run() {
    {
      const Running running;
      const StopRequest request([this] { return asked_to_stop.load(std::memory_order_relaxed); });
      try {
        value.emplace(compute());
      } catch (...) {
        failed = std::current_exception();
      }
    }
    const std::lock_guard lock(mutex);
    done = true;
    changed.notify_one();
  }
  // Waits for a moment without the interpreter's lock; returns whether the computation has ended.
  bool wait() {
    constexpr std::chrono::milliseconds kPause{20};
    const nb::gil_scoped_release release;
    std::unique_lock lock(mutex);
    return changed.wait_for(lock, kPause, [&] { return done.load(); });
  }
};

// Returns f(), computed without the interpreter's lock. f owns all it reads. Throws nb::python_error if a handler of
// signals raises, as that of Ctrl-C does: at most 20 ms after the signal the computation is asked to stop, and this
// function waits until it has stopped. If another signal comes meanwhile, the thread is abandoned.
template <class F>
auto interruptible(F f) {
  const auto shared = std::make_shared<Interruptible<F>>(std::move(f));
  std::thread thread([shared] { shared->run(); });
  while (!shared->wait())
    if (PyErr_CheckSignals() != 0) {
      const nb::python_error raised;
      shared->asked_to_stop = true;
      while (!shared->wait())
        if (PyErr_CheckSignals() != 0) {
          PyErr_Clear();
          Abandoned::threads().add(std::move(thread), {shared, &shared->done});
          throw raised;
        }
      thread.join();
      throw raised;
    }
  thread.join();
  if (shared->failed) std::rethrow_exception(shared->failed);
  return *std::move(shared->value);
}

}  // namespace anholon::python
