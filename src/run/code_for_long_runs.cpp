#include "run/code_for_long_runs.h"

#include <cstdlib>
#include <mutex>
#include <vector>

namespace anholon {

namespace {

struct Left {
  std::shared_ptr<std::atomic<bool>> done;
  std::thread thread;
};
std::mutex left_lock;
std::vector<Left>& left_behind() {
  static auto* const list = new std::vector<Left>;  // outlives every destructor
  return *list;
}

}  // namespace

CodeForLongRuns::~CodeForLongRuns() { leave(); }

void CodeForLongRuns::leave() {
  if (!compilation_.thread.joinable()) return;
  if (*compilation_.done) return compilation_.thread.join();
  // The compiler's own destructors run after this if it is loaded before, which its thread may not have come to yet.
  compiler();
  static const int once = std::atexit([] {
    for (Left& l : left_behind()) l.thread.join();
  });
  (void)once;
  const std::lock_guard lock(left_lock);
  left_behind().push_back({compilation_.done, std::move(compilation_.thread)});
}

void CodeForLongRuns::step(const std::shared_ptr<const KernelPlan>& plan, int lanes) {
  // A compilation takes 0.1 to 2 s, on another core if there is one.
  constexpr std::chrono::milliseconds kLong(400);
  constexpr std::size_t kSometimes = 64;
  if (!plan || compilation_.plan == plan || (lanes == 1 && ++asked_ % kSometimes != 0) || (compilation_.done && !*compilation_.done)) return;
  if (std::chrono::steady_clock::now() - since_ < kLong) return;
  leave();
  const auto done = std::make_shared<std::atomic<bool>>(false);
  compilation_ = {plan, done, std::thread([plan, lanes, done] {
                    plan->compile(code_cache(), lanes);
                    *done = true;
                  })};
}

bool compiling_for_nobody() {
  const std::lock_guard lock(left_lock);
  for (const Left& l : left_behind())
    if (!*l.done) return true;
  return false;
}

}  // namespace anholon
