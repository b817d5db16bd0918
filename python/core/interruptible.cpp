#include "interruptible.h"

#include <cstdlib>

namespace anholon::python {

Abandoned& Abandoned::threads() {
  static Abandoned all;
  return all;
}

void Abandoned::forget_finished() {
  std::erase_if(list_, [](One& one) {
    if (!*one.done) return false;
    one.thread.join();
    return true;
  });
}

void Abandoned::add(std::thread thread, std::shared_ptr<const std::atomic<bool>> done) {
  forget_finished();
  list_.push_back({std::move(thread), std::move(done)});
}

void Abandoned::wait() {
  constexpr int kInterrupted = 130;  // as a shell tells SIGINT
  forget_finished();
  if (list_.empty()) return;
  PySys_WriteStderr("anholon: an interrupted computation ends first; Ctrl-C ends the process now\n");
  for (; !list_.empty(); forget_finished()) {
    if (PyErr_CheckSignals() != 0) std::_Exit(kInterrupted);
    const nb::gil_scoped_release release;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

}  // namespace anholon::python
