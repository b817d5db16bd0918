#include "ensemble/cases/case_worker.h"

#include <algorithm>

#include "base/thread_time.h"
#include "ensemble/case_scenario.h"
#include "ensemble/columns.h"
#include "ensemble/reduce/reducer.h"

namespace anholon {

// Contains failures, so that a case never stops the others.
template <class Work>
static bool contained(CaseResult& r, const Work& work) {
  try {
    work();
    return true;
  } catch (const Failure& e) {
    r.outcome = {OutcomeKind::too_large, e.diagnostic.message, e.diagnostic.hint};
  } catch (const std::bad_alloc&) {
    r.outcome = {OutcomeKind::too_large, "out of memory", "fewer threads need less"};
  }
  return false;
}

void CaseWorker::integrate(std::span<CaseResult> results) {
  if (results.empty()) return;
  const SweepLanes::Turn turn = plan_.lanes.begin(plan_.kernel, results.front().number);
  const double begun = seconds_of_this_thread();
  integrate(together(turn.lanes), results);
  plan_.lanes.end(turn, results.size(), seconds_of_this_thread() - begun);
}

CaseWorker::Together& CaseWorker::together(int lanes) {
  const auto [at, made] = together_.try_emplace(lanes);
  Together& t = at->second;
  if (!made) return t;
  t.walks.resize(static_cast<std::size_t>(lanes));
  if (!plan_.kernel) return t;
  t.kernel = std::make_shared<Kernel>(plan_.kernel, lanes);
  if (lanes > 1) t.ordinary.emplace(t.kernel, plan_.settings);
  return t;
}

// A lane takes the next case when it has finished one. The bits of a case do not depend on the other lanes.
void CaseWorker::integrate(Together& together, std::span<CaseResult> results) {
  auto& [kernel, ordinary, walks] = together;
  std::vector<OrdinarySteps::Motion> motions;
  std::size_t next = 0, walking = 0;
  const auto go = [&](CaseWalk& walk, CaseWay (CaseWalk::*part)()) {
    if (!walk.walking()) return;
    CaseResult& r = walk.result();
    CaseWay way = CaseWay::plain;
    const bool done = contained(r, [&] { way = (walk.*part)(); });
    if (!done) walk.abandon();
    if (walk.walking()) return;
    --walking;
    if (done) contained(r, [&] { end(way, walk.numbers(), r); });
  };
  for (;;) {
    for (std::size_t lane = 0; lane < walks.size(); ++lane)
      while (!walks[lane].walking() && next < results.size()) {
        CaseResult& r = results[next++];
        CaseWalk& walk = walks[lane];
        const bool done = contained(r, [&] {
          const CaseWay way = walk.begin(plan_, r, kernel, static_cast<int>(lane));
          if (!walk.walking()) end(way, walk.numbers(), r);
        });
        if (!done) walk.abandon();
        if (walk.walking()) ++walking;
      }
    if (walking == 0) return;
    if (walks.size() == 1) {
      go(walks[0], &CaseWalk::step);
      continue;
    }
    for (CaseWalk& w : walks) go(w, &CaseWalk::begin_step);
    if (kernel) kernel->begin();
    bool aimed = false;
    if (ordinary) {
      motions.clear();
      for (const CaseWalk& w : walks) motions.push_back(w.motion());
      aimed = ordinary->run(motions);
    }
    if (!aimed)
      for (CaseWalk& w : walks) go(w, &CaseWalk::aim);
    for (bool again = kernel != nullptr; again; aimed = false) {
      if (!aimed) {
        kernel->advance();
        kernel->start_next();
      }
      again = false;
      for (CaseWalk& w : walks) {
        go(w, &CaseWalk::look_at_end);
        again = again || (w.walking() && w.looks_elsewhere());
      }
    }
    for (CaseWalk& w : walks) go(w, &CaseWalk::finish_step);
  }
}

void CaseWorker::end(CaseWay way, const EnsembleCase& numbers, CaseResult& r) {
  if (way == CaseWay::simulation) {
    by_simulation(numbers, r);
    // A case that fails at its start may have another structure there, or other redundant constraints.
    if (!r.outcome.ok() && r.steps == 0 && r.outcome.kind != OutcomeKind::inconsistent &&
        r.outcome.kind != OutcomeKind::interrupted)
      way = CaseWay::derivation;
  }
  if (way == CaseWay::derivation) by_derivation(numbers, r);
}

namespace {

// Keeps the columns of an ensemble from the rows of `simulate`.
class EnsembleRowFilter final : public RowSink {
 public:
  EnsembleRowFilter(const Model& model, const std::vector<Rational>& times, CaseResult& result)
      : model_(model), result_(result) {
    for (const Rational& t : times) times_.push_back(from_rational<double>(t));
  }
  void columns(const std::vector<RunColumn>& columns) override { kept_ = ensemble_places(model_, columns); }
  void row(const Row& row) override {
    const double t = row.values[0];
    result_.t = t;
    result_.last.clear();
    for (const std::optional<std::size_t>& k : kept_) result_.last.push_back(k ? row.values[*k] : kNoValue);
    if (std::find(times_.begin(), times_.end(), t) == times_.end()) return;
    std::vector<double>& kept = result_.rows.emplace_back();
    kept.push_back(t);
    kept.insert(kept.end(), result_.last.begin(), result_.last.end());
  }

 private:
  const Model& model_;
  std::vector<double> times_;
  CaseResult& result_;
  std::vector<std::optional<std::size_t>> kept_;  // the places of the columns
};

}  // namespace

void CaseWorker::simulate_case(Workspace& own, const EnsembleCase& numbers, CaseResult& r) {
  const EnsembleOptions& o = plan_.options;
  r.rows.clear();
  r.last.clear();
  r.reduced.clear();
  r.event.clear();
  const Rational to = numbers.to ? *numbers.to : o.to;
  SimulationOptions options = options_of_case(o, numbers);
  for (const Rational& t : o.at)
    if (to < Rational(own.state.t) ? t > to : t < to) options.at.push_back(t);
  options.at.push_back(to);
  std::sort(options.at.begin(), options.at.end());
  options.order = o.order;
  options.method = o.method;
  options.kernel = o.kernel;
  Reducer reducer(o.reductions, o.tolerance.get_d());
  const std::size_t ends = o.reductions.ends.size(), formulas = o.reductions.formulas.size();
  bool any_step = false;
  if (formulas + ends > 0) {
    options.followed = formulas_in(own, o.reductions.formulas, o, {});
    const Column of_ends = formulas_in(own, o.reductions.ends, o, {});
    options.followed.insert(options.followed.end(), of_ends.begin(), of_ends.end());
    options.followed_at_ends = ends;
    options.dense = [&, ends, formulas](const StepPolynomials& step) {
      any_step = true;
      (void)reducer.step({step.end - step.begin, step.one_sided ? 0 : step.order - 1, step.followed,
                          [&](std::size_t i, double x) {
                            const auto [value, made_of] = step.followed_value(i, x);
                            return FormulaValue{value, made_of};
                          },
                          step.followed_hiding, true, step.kinks});
      std::vector<double> values;
      for (std::size_t i = 0; i < ends; ++i)
        values.push_back(step.followed_value(formulas + i, step.end - step.begin).first);
      reducer.ends(std::move(values));
    };
    options.stopped = [&, ends, formulas](const std::function<double(std::size_t)>& followed) {
      if (!any_step) {
        std::vector<double> at_start;
        for (std::size_t i = 0; i < formulas; ++i) at_start.push_back(followed(i));
        (void)reducer.step({0,
                            0,
                            [&](std::size_t i, int) { return at_start[i]; },
                            [&](std::size_t i, double) { return FormulaValue{at_start[i], std::abs(at_start[i])}; },
                            {}});
      }
      std::vector<double> values;
      for (std::size_t i = 0; i < ends; ++i) values.push_back(followed(formulas + i));
      reducer.ends(std::move(values));
    };
  }
  EnsembleRowFilter rows(*own.model, o.at, r);
  const SimulationReport report = o.own_motion ? o.own_motion(own, options, rows) : simulate_in(own, options, rows);
  for (const EventReport& e : report.events) {
    if (e.stop) r.event = e.name;
    reducer.event(e.name, e.t.value);
  }
  // Other methods, which motions with contacts use for slow slips, have no polynomials.
  r.without_polynomials = !report.method.turns.empty();
  if (r.without_polynomials) reducer.lose_formulas();
  const bool moved = report.outcome.ok() || report.steps > 0 || !report.events.empty();
  if (moved && !o.reductions.list.empty()) reducer.values(r.reduced);
  r.outcome = report.outcome;
  r.steps = report.steps;
  // The time of a motion that stops is that of its last good state.
  if (r.outcome.ok() || r.last.empty()) r.t = report.t;
}

void CaseWorker::by_simulation(const EnsembleCase& numbers, CaseResult& r) {
  ++in_workspaces_;
  Workspace own(plan_.of_all);
  const EnsembleOptions& o = plan_.options;
  for (std::size_t i = 0; i < o.varied.size(); ++i)
    if (const Varied& v = o.varied[i]; v.kind == Varied::Kind::parameter)
      own.set_parameter(v.index, v.unit.in_si(numbers.values[i]));
  const std::vector<StateOverride> overrides = overrides_of(o, &numbers);
  const bool may_be_no_rotation = !plan_.plain && plan_.parameters.may_be_no_rotation();
  if (may_be_no_rotation || (!overrides.empty() && r.replaced.empty())) {
    const std::vector<double> parameters = parameter_values<double>(*own.model);
    InitialState<double> start;
    const InitialProblem<double> problem{own.mechanics.get(), parameters, overrides,
                                         o.state.t,           nullptr,    own.start.get()};
    const bool begins = consistent_state(problem, start).ok();
    r.replaced = start.replaced.note;
    if (begins && may_be_no_rotation) r.outcome = plan_.parameters.oriented(parameters, start);
    if (r.t = start.t; !r.outcome.ok()) return;
  }
  simulate_case(own, numbers, r);
}

void CaseWorker::by_derivation(const EnsembleCase& numbers, CaseResult& r) {
  ++in_workspaces_;
  Scenario anew;
  r.outcome = scenario_of_case(plan_.of_all, plan_.options, numbers, anew);
  r.t = anew.state.t;
  r.replaced = anew.state.replaced.note;
  r.rows.clear();
  r.last.clear();
  r.reduced.clear();
  if (!r.outcome.ok()) return;
  Workspace own(anew);
  simulate_case(own, numbers, r);
}

}  // namespace anholon
