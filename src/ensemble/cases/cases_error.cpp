#include "ensemble/cases/cases_error.h"

#include "ensemble/case_scenario.h"
#include "ensemble/cases/case_parameters.h"
#include "ensemble/columns.h"
#include "model/exponents.h"
#include "observe/estimate.h"
#include "simulation/simulate.h"

namespace anholon {

namespace {

// True if a kernel computes the motions of a model, so that a run with other roundings shows their errors.
bool made_by_kernel(const Scenario& s) {
  const Program p = program(s.system, s.structure);
  return s.model->bounds.empty() && no_plan(p).empty();
}

// Makes further runs of cases, one after the other. All cases that have the equations of the first one share its
// workspace, and the plans that its run leaves.
class FurtherRuns {
 public:
  FurtherRuns(const Scenario& of_all, const EnsembleOptions& o)
      : of_all_(of_all), o_(o), exponents_vary_(!exponents_of(*clone(*of_all.model), varied_parameters(o)).empty()) {}

  // Makes the sharper run of a case and compares it with the result of the case.
  SimulationReport compare(const CaseResult& r);
  // Makes a run like the case's, with its residuals.
  SimulationReport look_at(const CaseResult& r);

 private:
  Outcome begin(const EnsembleCase& numbers);

  const Scenario& of_all_;
  const EnsembleOptions& o_;
  bool exponents_vary_;  // the exponents of one case may be constants of the workspace
  std::unique_ptr<Workspace> own_;
  std::optional<CaseParameters> parameters_;  // of the workspace
  RunToJudge<long double>::Plans compared_;
  SimulationPlans looked_at_;
};

// Makes the workspace that of a case. The present workspace gets other numbers if its equations are those of the case,
// too.
Outcome FurtherRuns::begin(const EnsembleCase& numbers) {
  StateChoice state = o_.state;
  state.overrides = overrides_of(o_, &numbers);
  if (own_ && !exponents_vary_ && !o_.each_anew && !o_.own_motion &&
      parameters_->same_structure(parameters_->values<double>(numbers.values))) {
    for (std::size_t i = 0; i < o_.varied.size(); ++i)
      if (const Varied& v = o_.varied[i]; v.kind == Varied::Kind::parameter)
        own_->set_parameter(v.index, v.unit.in_si(numbers.values[i]));
    if (const std::optional<Outcome> begun = begin_anew(*own_, state)) return *begun;
  }
  compared_ = {};
  looked_at_ = {};
  parameters_.reset();
  own_.reset();
  Scenario of_case;
  const Outcome o = scenario_of_case(of_all_, o_, numbers, of_case);
  if (!o.ok()) return o;
  own_ = std::make_unique<Workspace>(of_case);
  parameters_.emplace(*own_, o_);
  return o;
}

SimulationReport FurtherRuns::compare(const CaseResult& r) {
  SimulationReport report;
  const EnsembleCase numbers = o_.numbers(r.number);
  if (!begin(numbers).ok()) return report;
  const EnsembleOptions& o = o_;
  Workspace& s = *own_;
  SimulationOptions options = options_of_case(o, numbers);
  options.estimate = o.estimate;
  RunToJudge<long double> run;
  const std::vector<std::optional<std::size_t>> places =
      ensemble_places(*s.model, columns_after_time(s, largest_order(s, s.structure.d)));
  for (const std::optional<std::size_t>& place : places)
    if (place) run.columns.push_back(*place);
  run.knows_resets = false;
  run.plans = &compared_;
  run.by_kernel = o.kernel && made_by_kernel(s);
  report.steps = r.steps;
  const auto end = from_rational<long double>(numbers.to ? *numbers.to : o.to);
  const auto add = [&](long double t, auto begin, auto last) {
    std::vector<long double> row;
    for (std::size_t k = 0; begin != last; ++begin, ++k)
      if (places[k]) row.push_back(*begin);
    run.rows.add(t, row, 0);
  };
  for (const std::vector<double>& row : r.rows) add(row[0], row.begin() + 1, row.end());
  // The results contain the double nearest to the requested time.
  add(static_cast<double>(end) == r.t ? end : r.t, r.last.begin(), r.last.end());
  estimate_error<double>(s, options, run, report);
  return report;
}

}  // namespace

namespace {

// The results that can be judged.
std::vector<const CaseResult*> fit_for_judgement(const EnsembleOptions& o, std::span<const CaseResult> results) {
  std::vector<const CaseResult*> fit;
  for (const CaseResult& r : results)
    if (r.outcome.ok() && r.steps > 0 && (o.estimate == ErrorEstimate::always || r.steps <= kShortRun))
      fit.push_back(&r);
  return fit;
}

std::string none_is_fit(const EnsembleOptions& o, std::span<const CaseResult> results) {
  if (!results.empty() &&
      std::all_of(results.begin(), results.end(), [](const CaseResult& r) { return r.outcome.ok() && r.steps == 0; }))
    return "the motions of the cases looked at end where they begin";
  return "none of the cases looked at has finished" +
         std::string(o.estimate == ErrorEstimate::always ? "" : " within " + std::to_string(kShortRun) + " steps");
}

class NoRows final : public RowSink {
 public:
  void columns(const std::vector<RunColumn>&) override {}
  void row(const Row&) override {}
};

SimulationReport FurtherRuns::look_at(const CaseResult& r) {
  SimulationReport report;
  const EnsembleCase numbers = o_.numbers(r.number);
  if (report.outcome = begin(numbers); !report.outcome.ok()) return report;
  SimulationOptions options = options_of_case(o_, numbers);
  options.to = numbers.to ? *numbers.to : o_.to;
  options.order = o_.order;
  options.method = o_.method;
  options.kernel = o_.kernel;
  NoRows rows;
  return o_.own_motion ? o_.own_motion(*own_, options, rows) : simulate_in(*own_, options, rows, &looked_at_);
}

// The reports of two further runs of a case.
struct Judged {
  SimulationReport compared, looked_at;
};

// The number of cases that follow one another with the same equations: all cases of short runs, for which deriving the
// equations would take longer than the runs. Other cases are judged side by side.
std::size_t cases_in_turn(const EnsembleOptions& o, std::size_t cases) {
  return o.estimate == ErrorEstimate::always ? 1 : std::max<std::size_t>(cases, 1);
}

CasesError error_of(const EnsembleOptions& o, std::span<const CaseResult* const> fit, std::span<const Judged> judged) {
  CasesError all;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    const SimulationReport& r = o.own_motion ? judged[i].looked_at : judged[i].compared;
    if (!r.error) {
      all.none = r.no_error;
      continue;
    }
    all.cases.push_back(fit[i]->number);
    if (!all.error || r.error->worst().error > all.error->worst().error) all.worst = fit[i]->number;
    if (!all.error)
      all.error = r.error;
    else
      all.error->take_worse(*r.error);
  }
  return all;
}

CasesResiduals residuals_of(std::span<const CaseResult* const> fit, std::span<const Judged> judged) {
  CasesResiduals all;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    const SimulationReport& r = judged[i].looked_at;
    if (!r.outcome.ok()) {
      all.none = r.outcome.message;
      continue;
    }
    const auto take = [&](CasesResiduals::Worst& worst, double residual) {
      if (all.cases.empty() || residual > worst.residual) worst = {residual, fit[i]->number};
    };
    take(all.newton, r.newton), take(all.constraints, r.constraints_kept), take(all.power, r.power);
    all.cases.push_back(fit[i]->number);
  }
  return all;
}

}  // namespace

std::vector<std::size_t> cases_to_compare(std::size_t cases) {
  constexpr std::size_t kFew = 3, kMany = 8, kManyCases = 20'000;
  const std::size_t count = std::min(cases, cases < kManyCases ? kFew : kMany);
  std::vector<std::size_t> list;
  for (std::size_t k = 0; k < count; ++k) list.push_back(count == 1 ? 0 : k * (cases - 1) / (count - 1));
  return list;
}

void judge_cases(const Scenario& scenario, const EnsembleOptions& o, std::span<const CaseResult> results,
                 const Each& each, EnsembleReport& report) {
  const std::vector<const CaseResult*> fit = fit_for_judgement(o, results);
  std::vector<Judged> judged(fit.size());
  const std::size_t in_turn = cases_in_turn(o, fit.size());
  each(2 * ((fit.size() + in_turn - 1) / in_turn), [&](std::size_t task) {
    const bool compares = task % 2 == 0;
    // Motions that are no motion of one system, as those with contacts, say themselves why they have no estimate.
    if (compares && o.own_motion) return;
    FurtherRuns runs(scenario, o);
    for (std::size_t i = task / 2 * in_turn; i < std::min(fit.size(), (task / 2 + 1) * in_turn); ++i) {
      try {
        if (compares)
          judged[i].compared = runs.compare(*fit[i]);
        else
          judged[i].looked_at = runs.look_at(*fit[i]);
      } catch (const Failure& e) {
        if (compares)
          judged[i].compared.no_error = e.diagnostic.message;
        else
          judged[i].looked_at.outcome = {OutcomeKind::too_large, e.diagnostic.message, e.diagnostic.hint};
      }
    }
  });
  report.error = error_of(o, fit, judged);
  report.residuals = residuals_of(fit, judged);
  if (!report.error.error && report.error.none.empty()) report.error.none = none_is_fit(o, results);
  if (report.residuals.cases.empty() && report.residuals.none.empty()) report.residuals.none = none_is_fit(o, results);
}

}  // namespace anholon
