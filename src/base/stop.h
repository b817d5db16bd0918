// Requests to stop a computation on expressions: reading, derivation, proof, comparison.
//
// Whoever waits for the computation opens a StopScope in the thread that computes. Loops that may take long call
// look_for_stop; it throws StopRequested if an open scope of the thread asks for an end. The layers hold no results
// that a throw could leave half made: they build in graphs of their own, which are dropped with them.
#pragma once
#include <functional>
#include <utility>

namespace anholon {

// Derives from nothing, so that no handler of errors takes it for an error.
struct StopRequested {};

// While it exists, look_for_stop in this thread asks `asked`, which is called often and so has to be cheap. Scopes nest:
// each of them may stop what is computed in the innermost.
class StopScope {
 public:
  explicit StopScope(std::function<bool()> asked) : asked_(std::move(asked)), outer_(std::exchange(innermost_, this)) {}
  ~StopScope() { innermost_ = outer_; }
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

 private:
  friend void look_for_stop();
  std::function<bool()> asked_;
  StopScope* outer_;
  static inline constinit thread_local StopScope* innermost_ = nullptr;
};

// Throws StopRequested if one of the open scopes of this thread asks for an end.
inline void look_for_stop() {
  for (const StopScope* s = StopScope::innermost_; s; s = s->outer_)
    if (s->asked_()) throw StopRequested{};
}

}  // namespace anholon
