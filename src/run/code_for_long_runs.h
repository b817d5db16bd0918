// Machine code for a kernel that has been at work for a while, made beside the motion; its bits are the same.
#pragma once
#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>

#include "kernel/kernel.h"

namespace anholon {

class CodeForLongRuns {
 public:
  // Asked at every step.
  void step(const std::shared_ptr<const KernelPlan>& plan) {
    // A compilation takes 0.1 to 1 s, on another core if there is one.
    constexpr std::chrono::milliseconds kLong(400);
    constexpr std::size_t kSometimes = 64;
    if (!plan || ++asked_ % kSometimes != 0 || (compilation_ && (compilation_->plan == plan || !*compilation_->done))) return;
    if (std::chrono::steady_clock::now() - since_ < kLong) return;
    const auto done = std::make_shared<std::atomic<bool>>(false);
    compilation_.reset();
    compilation_.emplace(Compilation{plan, done, std::jthread([plan, done] {
                                       plan->compile(code_cache());
                                       *done = true;
                                     })});
  }

 private:
  struct Compilation {
    std::shared_ptr<const KernelPlan> plan;
    std::shared_ptr<std::atomic<bool>> done;
    std::jthread thread;
  };
  std::optional<Compilation> compilation_;
  std::chrono::steady_clock::time_point since_ = std::chrono::steady_clock::now();
  std::size_t asked_ = 0;
};

}  // namespace anholon
