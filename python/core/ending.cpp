#include "ending.h"

#include <cstdlib>
#include <mutex>
#include <thread>

namespace anholon::python {

namespace {

std::thread::id ending_thread;  // written once, before begun()

constexpr std::chrono::milliseconds kPause{5};

}  // namespace

bool Ending::elsewhere() { return begun_ && std::this_thread::get_id() != ending_thread; }

void Ending::stay() {
  PyEval_SaveThread();
  for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
}

void Ending::wait() {
  constexpr int kInterrupted = 130;  // the exit status of a shell for SIGINT
  constexpr std::chrono::milliseconds kPatience{300};
  ending_thread = std::this_thread::get_id();
  begun_ = true;
  bool told = false;
  for (const auto from = std::chrono::steady_clock::now(); running_ > 0 || unlocked_ > 0;) {
    if (!told && std::chrono::steady_clock::now() - from > kPatience) {
      PySys_WriteStderr("anholon: a computation in another thread ends first; Ctrl-C ends the process now\n");
      told = true;
    }
    if (PyErr_CheckSignals() != 0) std::_Exit(kInterrupted);
    // Unlocked is not used, because this loop waits for its objects.
    const nanobind::gil_scoped_release release;
    std::this_thread::sleep_for(kPause);
  }
}

void Ending::forget_other_threads() { running_ = 0, unlocked_ = 0; }

Unlocked::Unlocked() {
  if (Ending::elsewhere()) Ending::stay();
  ++Ending::unlocked_;
  state_ = PyEval_SaveThread();
}

Unlocked::~Unlocked() {
  if (Ending::elsewhere()) {
    --Ending::unlocked_;
    for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
  }
  // If the end begins now, it waits until this thread has the lock.
  PyEval_RestoreThread(state_);
  --Ending::unlocked_;
}

}  // namespace anholon::python
