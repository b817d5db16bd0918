#include "motion/code_for_long_runs.h"

#include <chrono>
#include <cmath>
#include <mutex>
#include <vector>

#include "base/thread_time.h"

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

void wait_for_left_behind() {
  std::vector<Left> list;
  {
    const std::lock_guard lock(left_lock);
    list.swap(left_behind());
  }
  for (Left& l : list) l.thread.join();
}

// The compiler makes statics while it runs, and exit() destroys the latest statics first, so a static that waits would
// wait too late for a thread that still compiles. Objects of the main thread are destroyed before all statics.
struct WaitsAtTheEndOfMain {
  ~WaitsAtTheEndOfMain() { wait_for_left_behind(); }
  void arm() {}
};
thread_local WaitsAtTheEndOfMain waits;
[[maybe_unused]] const bool armed = (waits.arm(), true);  // runs in the thread that initializes the program

}  // namespace

CodeForLongRuns::~CodeForLongRuns() { leave(); }

void CodeForLongRuns::leave() {
  if (!compilation_.thread.joinable()) return;
  if (*compilation_.done) return compilation_.thread.join();
  const std::lock_guard lock(left_lock);
  std::erase_if(left_behind(), [](Left& l) { return *l.done && (l.thread.join(), true); });
  left_behind().push_back({compilation_.done, std::move(compilation_.thread)});
}

double CodeForLongRuns::seconds_to_make(const KernelPlan& plan, int lanes) {
  // The seconds until the compiler is loaded, and its seconds for each step of a stage.
  constexpr double kLoadedSoon = 0.02;
  const double each_step = translated_at_first(lanes) ? 0.00025 : 0.0015;
  return kLoadedSoon + each_step * static_cast<double>(plan.plan().stage.size());
}

void CodeForLongRuns::step(const std::shared_ptr<const KernelPlan>& plan, double at, double end, int lanes,
                           std::optional<double> spent) {
  // Seconds: how long the motion is observed before a compilation, and the compiler's time for better code, for each
  // step of a stage.
  constexpr double kObserved = 0.001, kObservedLonger = 0.025, kEachStep = 0.006;
  // The least part of the time that the better code saves. In lanes a smaller part of the time is spent in the code,
  // the smaller the shorter the code is, and the compiler takes its time from the cases.
  const double stage = plan ? static_cast<double>(plan->plan().stage.size()) : 0;
  const double better = lanes == 1 ? 0.15 : std::min(0.1, 0.001 * stage);
  constexpr std::size_t kSometimes = 64;
  if (!first_) first_ = point(at, spent, lanes);
  const bool known = compilation_.plan == plan;
  if (!plan || (known && compilation_.effort == CodeEffort::full) || (lanes == 1 && ++asked_ < kSometimes) ||
      (compilation_.done && !*compilation_.done))
    return;
  asked_ = 0;
  const Code* code = plan->code(lanes);
  const Point now = point(at, spent, lanes);
  const auto left = [&](const Point& since, double observed) {
    const double elapsed = now.seconds - since.seconds, done = std::abs(at - since.at);
    return elapsed < observed ? 0 : elapsed / done * (std::abs(end - at) * times_ + done * (times_ - 1));
  };
  if (!code) {
    if (!known && left(*first_, kObserved) > seconds_to_make(*plan, lanes)) begin(plan, lanes, CodeEffort::quick);
  } else if (code->effort == CodeEffort::quick) {
    if (!since_quick_) since_quick_ = now;
    if (left(*since_quick_, kObservedLonger) * better > kEachStep * stage) begin(plan, lanes, CodeEffort::full);
  }
}

// A single motion is computed by one thread, whose time is measured; cases in lanes are computed by several threads,
// for which the clock is read.
CodeForLongRuns::Point CodeForLongRuns::point(double at, std::optional<double> spent, int lanes) {
  using Seconds = std::chrono::duration<double>;
  if (spent) return {*spent, at};
  return {lanes == 1 ? seconds_of_this_thread() : Seconds(std::chrono::steady_clock::now().time_since_epoch()).count(),
          at};
}

void CodeForLongRuns::begin(const std::shared_ptr<const KernelPlan>& plan, int lanes, CodeEffort effort) {
  leave();
  since_quick_.reset();
  const auto ready = std::make_shared<std::atomic<bool>>(false);
  compilation_ = {plan, effort, ready, std::thread([plan, lanes, effort, ready] {
                    plan->compile(code_cache(), lanes, effort);
                    *ready = true;
                  })};
}

bool compiling_for_nobody() {
  const std::lock_guard lock(left_lock);
  for (const Left& l : left_behind())
    if (!*l.done) return true;
  return false;
}

}  // namespace anholon
