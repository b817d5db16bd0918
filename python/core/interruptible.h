// Computations that cannot be asked to stop, in threads of their own: Ctrl-C returns to the user at once, and the thread
// ends when it is done; its value is lost.
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

// Returns f(), computed without the interpreter's lock. f owns all it reads. Throws nb::python_error if a handler of
// signals raises, as that of Ctrl-C does, at most 20 ms after the signal.
template <class F>
auto interruptible(F f) {
  struct Shared {
    explicit Shared(F g) : compute(std::move(g)) {}
    F compute;
    std::mutex mutex;
    std::condition_variable changed;
    std::optional<decltype(std::declval<F&>()())> value;
    std::exception_ptr failed;
    std::atomic<bool> done{false};
  };
  constexpr std::chrono::milliseconds kPause{20};
  const auto shared = std::make_shared<Shared>(std::move(f));
  std::thread thread([shared] {
    try {
      shared->value.emplace(shared->compute());
    } catch (...) {
      shared->failed = std::current_exception();
    }
    const std::lock_guard lock(shared->mutex);
    shared->done = true;
    shared->changed.notify_one();
  });
  const auto ready = [&] {
    const nb::gil_scoped_release release;
    std::unique_lock lock(shared->mutex);
    return shared->changed.wait_for(lock, kPause, [&] { return shared->done.load(); });
  };
  while (!ready())
    if (PyErr_CheckSignals() != 0) {
      nb::python_error raised;
      Abandoned::threads().add(std::move(thread), {shared, &shared->done});
      throw raised;
    }
  thread.join();
  if (shared->failed) std::rethrow_exception(shared->failed);
  return *std::move(shared->value);
}

}  // namespace anholon::python
