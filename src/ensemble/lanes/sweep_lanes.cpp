#include "ensemble/lanes/sweep_lanes.h"

#include <algorithm>

namespace anholon {

SweepLanes::SweepLanes(std::size_t cases, std::size_t threads, int narrow, int wide)
    : cases_(cases), compiles_beside_(threads > 0 && threads < std::thread::hardware_concurrency()) {
  constexpr std::size_t kMany = 32;
  widths_[0].lanes = cases < kMany ? 1 : narrow;
  widths_[1].lanes = cases < kMany ? 1 : wide;
  phase_ = widths_[0].lanes == widths_[1].lanes ? Phase::decided : Phase::narrow;
}

// Several groups are needed, because one group is short and its cases may differ from those of others.
bool SweepLanes::Width::measured() const {
  constexpr std::size_t kGroups = 8;
  constexpr double kSeconds = 0.01;
  return groups >= kGroups && seconds > kSeconds;
}

SweepLanes::Turn SweepLanes::begin(const std::shared_ptr<const KernelPlan>& plan, std::size_t next) {
  if (!plan) return {};
  if (const std::unique_lock lock(lock_, std::try_to_lock); lock) look(plan, next);
  const int lanes = widths_[now_].lanes;
  return {lanes, plan->code(lanes) != nullptr};
}

void SweepLanes::end(const Turn& turn, std::size_t cases, double seconds) {
  if (!turn.compiled) return;
  const std::lock_guard lock(lock_);
  Width& w = widths_[turn.lanes == widths_[0].lanes ? 0 : 1];
  w.cases += cases;
  w.seconds += seconds;
  ++w.groups;
}

void SweepLanes::look(const std::shared_ptr<const KernelPlan>& plan, std::size_t next) {
  auto& [narrow, wide] = widths_;
  switch (phase_) {
  case Phase::narrow:
    if (wide_may_pay(*plan, next))
      phase_ = Phase::compiling_wide;
    else
      step(narrow, plan, next);
    break;
  case Phase::compiling_wide:
    step(wide, plan, next);
    if (plan->code(wide.lanes)) now_ = 1, phase_ = Phase::measuring_wide;
    break;
  case Phase::measuring_wide:
    if (!wide.measured()) break;
    now_ = wide.seconds_of_case() < narrow.seconds_of_case() ? 1 : 0;
    phase_ = Phase::decided;
    break;
  case Phase::decided:
    step(widths_[now_], plan, next);
  }
}

void SweepLanes::step(Width& width, const std::shared_ptr<const KernelPlan>& plan, std::size_t next) {
  width.code.step(plan, static_cast<double>(next), static_cast<double>(cases_), width.lanes);
}

// True if the gain, about a tenth of the time of the remaining cases, exceeds the time of the compiler, which the
// compiler takes from the cases if no core is idle.
bool SweepLanes::wide_may_pay(const KernelPlan& plan, std::size_t next) const {
  const double times = compiles_beside_ ? 2 : 10;
  const auto& [narrow, wide] = widths_;
  return narrow.measured() && narrow.seconds_of_case() * static_cast<double>(cases_ - std::min(cases_, next)) >
                                  times * CodeForLongRuns::seconds_to_make(plan, wide.lanes);
}

}  // namespace anholon
