// Requests to stop a computation on expressions: reading, derivation, proof, comparison.
//
// A caller that waits for the computation opens a StopScope in the thread that computes. Loops that may take long call
// look_for_stop; it throws StopRequested if an open scope of the thread asks for an end. The layers hold no results
// that a throw could leave incomplete: they build in graphs of their own, which are destroyed with them.
#pragma once
#include <functional>
#include <utility>

namespace anholon {

// Has no base class, so that no handler of errors catches it as an error.
struct StopRequested {};

// While a scope exists, look_for_stop in this thread calls `asked` often, so `asked` has to be cheap. Scopes nest: each
// of them may stop the computation in the innermost.
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
