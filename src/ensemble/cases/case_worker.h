// Computes cases of an ensemble in one of many threads.
//
// Plain cases walk side by side in the lanes of a kernel (case_walk.h). A case that stops other than by an event, or
// needs completed states, redundant constraints or another elimination, is computed by `simulate` in a workspace of its
// own, so its outcome is that of `simulate`. A case whose equations have another structure is derived anew.
#pragma once
#include <deque>
#include <map>

#include "ensemble/cases/case_walk.h"

namespace anholon {

// The workspaces of one thread.
class CaseWorker {
 public:
  explicit CaseWorker(const EnsemblePlan& plan) : plan_(plan) {}

  // Computes the cases whose numbers are in the results.
  void integrate(std::span<CaseResult> results);
  std::size_t in_workspaces() const { return in_workspaces_; }

 private:
  using W = Wider<double>;

  // A kernel, and a case in each of its lanes.
  struct Together {
    std::shared_ptr<Kernel> kernel{};
    std::optional<OrdinarySteps> ordinary{};
    std::deque<CaseWalk> walks{};
  };
  Together& together(int lanes);
  void integrate(Together& together, std::span<CaseResult> results);
  void end(CaseWay way, const EnsembleCase& numbers, CaseResult& result);
  void by_simulation(const EnsembleCase& numbers, CaseResult& result);
  void by_derivation(const EnsembleCase& numbers, CaseResult& result);
  void simulate_case(Workspace& own, const EnsembleCase& numbers, CaseResult& result);

  const EnsemblePlan& plan_;
  std::map<int, Together> together_;  // by the number of lanes
  std::size_t in_workspaces_ = 0;
};

}  // namespace anholon
