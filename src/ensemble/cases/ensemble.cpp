#include "ensemble/cases/ensemble.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <thread>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include "base/assert.h"
#include "ensemble/cases/case_worker.h"
#include "ensemble/cases/cases_error.h"

namespace anholon {

namespace {

// The number of cases that are integrated together, in the lanes of one kernel; it does not depend on the number of
// threads.
std::size_t together(std::size_t cases) {
  constexpr std::size_t kMost = 32, kFew = 8;
  return std::clamp<std::size_t>(cases / kFew, 1, kMost);
}

// The most cases in work per thread, in groups of any size: the others go on beside a case that takes long.
constexpr std::size_t kWindow = 256;

// Debian's libtbb is not compiled for ThreadSanitizer, which therefore does not know that a thread's data were ready,
// nor that one stage ends before the next begins. `joined`, `ready` and the lock of the two ordered stages tell it, so
// that it finds all other races.
void joined() {
  static std::mutex all;
  const std::lock_guard lock(all);
}

struct Group {
  std::vector<CaseResult> cases;
  std::atomic<bool> ready{false};
  void hand_over() { ready.store(true, std::memory_order_release); }
  std::vector<CaseResult>& take() {
    while (!ready.exchange(false, std::memory_order_acquire)) {
    }
    return cases;
  }
};

// Calls f(i) for all i < count, on `threads` threads.
void for_each_number(std::size_t count, std::size_t threads, const std::function<void(std::size_t)>& f) {
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i; (i = next++) < count;) f(i);
  };
  std::vector<std::jthread> others;
  while (others.size() + 1 < std::min(threads, count)) others.emplace_back(work);
  work();
}

}  // namespace

EnsembleReport ensemble(const Scenario& s, const EnsembleOptions& o, CaseSink& sink) {
  ANHOLON_ASSERT(o.numbers);
  const auto start = std::chrono::steady_clock::now();
  EnsembleReport report;
  report.threads = o.threads > 0 ? o.threads : static_cast<std::size_t>(tbb::info::default_concurrency());
  const EnsemblePlan plan(s, o);
  const std::size_t group = together(o.cases);
  const auto cancelled = [&] { return o.cancelled && o.cancelled(); };

  tbb::enumerable_thread_specific<CaseWorker> workers([&] { return CaseWorker(plan); });
  std::mutex in_order;
  std::size_t next = 0, known = o.more ? 0 : o.cases, held = 0;
  bool cut = false;
  const auto begin = [&](tbb::flow_control& flow) -> Group* {
    joined();
    const std::lock_guard lock(in_order);
    if (next >= known && o.more && !cancelled()) known += o.more();
    if (next >= known || cancelled()) {
      flow.stop();
      return nullptr;
    }
    auto* g = new Group;
    for (; next < known && g->cases.size() < group; ++next) g->cases.emplace_back().number = next;
    report.most_held = std::max(report.most_held, held += g->cases.size());
    g->hand_over();
    return g;
  };
  const auto integrate = [&](Group* g) {
    joined();
    workers.local().integrate(g->take());
    g->hand_over();
    return g;
  };
  const std::vector<std::size_t> to_compare =
      o.estimate == ErrorEstimate::never ? std::vector<std::size_t>{} : cases_to_compare(o.cases);
  std::vector<CaseResult> compared;
  const auto deliver = [&](Group* g) {
    joined();
    const std::unique_ptr<Group> owned(g);
    const std::lock_guard lock(in_order);
    for (const CaseResult& r : g->take()) {
      // A case that Ctrl-C has cut short is no result, and neither are later cases: the results are the first cases,
      // without a gap.
      cut = cut || (r.outcome.kind == OutcomeKind::interrupted && cancelled());
      if (cut) continue;
      sink.result(r);
      if (std::binary_search(to_compare.begin(), to_compare.end(), r.number)) compared.push_back(r);
      ++report.done;
      if (!r.replaced.empty()) report.replaced.add({1, r.replaced});
      if (!r.outcome.ok()) continue;
      ++report.finished;
      if (!r.event.empty()) ++report.events[r.event];
      for (std::size_t k = 0; k < r.reduced.size(); ++k)
        if (const Reduction& of = o.reductions.list[k]; !of.of_event() && std::isnan(r.reduced[k]))
          report.without_value[of.name].add({1, r.without_polynomials ? std::size_t{1} : std::size_t{0}});
    }
    held -= g->cases.size();
    if (o.progress) o.progress(report.done);
  };

  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, report.threads);
  tbb::task_arena arena(static_cast<int>(report.threads));
  joined();
  arena.execute([&] {
    tbb::parallel_pipeline(kWindow / group * report.threads,
                           tbb::make_filter<void, Group*>(tbb::filter_mode::serial_in_order, begin) &
                               tbb::make_filter<Group*, Group*>(tbb::filter_mode::parallel, integrate) &
                               tbb::make_filter<Group*, void>(tbb::filter_mode::serial_in_order, deliver));
  });
  const std::lock_guard lock(in_order);
  for (const CaseWorker& w : workers) report.in_workspaces += w.in_workspaces();
  if (report.done < known)
    report.outcome = {OutcomeKind::interrupted, "interrupted", "what was computed is kept"};
  else if (o.estimate != ErrorEstimate::never)
    judge_cases(
        s, o, compared, [&](std::size_t count, const auto& f) { for_each_number(count, report.threads, f); }, report);
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace anholon
