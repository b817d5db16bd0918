#include "ensemble/cases_error.h"

#include "ensemble/case_scenario.h"
#include "ensemble/columns.h"
#include "observe/estimate.h"

namespace anholon {

namespace {

// Whether a kernel makes the motions of a model, so that one with other roundings tells of their errors.
bool made_by_kernel(const Scenario& s) {
  const Program p = program(s.system, s.structure);
  return s.model->bounds.empty() && no_plan(p).empty();
}

SimulationReport compared(const Scenario& of_case, const EnsembleOptions& o, const EnsembleCase& numbers,
                          const CaseResult& r) {
  SimulationReport report;
  Workspace s(of_case);
  SimulationOptions options = options_of_case(o, numbers);
  options.estimate = o.estimate;
  RunToJudge<long double> run;
  run.columns = ensemble_places(columns_after_time(s, largest_order(s, s.structure.d)));
  run.knows_resets = false;
  run.by_kernel = o.kernel && made_by_kernel(s);
  report.steps = r.steps;
  const auto end = from_rational<long double>(numbers.to ? *numbers.to : o.to);
  const auto add = [&](long double t, auto begin, auto last) {
    run.rows.add(t, std::vector<long double>(begin, last), 0);
  };
  for (const std::vector<double>& row : r.rows) add(row[0], row.begin() + 1, row.end());
  // The results hold the double next to the time that was asked for.
  add(static_cast<double>(end) == r.t ? end : r.t, r.last.begin(), r.last.end());
  estimate_error<double>(s, options, run, report);
  return report;
}

}  // namespace

namespace {

// The results that are judged.
std::vector<const CaseResult*> fit_for_judgement(const EnsembleOptions& o, std::span<const CaseResult> results) {
  std::vector<const CaseResult*> fit;
  for (const CaseResult& r : results)
    if (r.outcome.ok() && r.steps > 0 && (o.estimate == ErrorEstimate::always || r.steps <= kShortRun))
      fit.push_back(&r);
  return fit;
}

std::string none_is_fit(const EnsembleOptions& o) {
  return "none of the cases looked at has finished" +
         std::string(o.estimate == ErrorEstimate::always ? "" : " within " + std::to_string(kShortRun) + " steps");
}

class NoRows final : public RowSink {
 public:
  void columns(const std::vector<RunColumn>&) override {}
  void row(const Row&) override {}
};

SimulationReport looked_at(const Scenario& of_case, const EnsembleOptions& o, const EnsembleCase& numbers) {
  SimulationOptions options = options_of_case(o, numbers);
  options.to = numbers.to ? *numbers.to : o.to;
  options.order = o.order;
  options.method = o.method;
  options.kernel = o.kernel;
  NoRows rows;
  return simulate(of_case, options, rows);
}

// The reports of two further runs of a case.
struct Judged {
  SimulationReport compared, looked_at;
};

// The two runs of one case, each with a scenario of its own, so that two threads can make them at once.
void compare(const Scenario& of_all, const EnsembleOptions& o, const CaseResult& r, SimulationReport& report) {
  const EnsembleCase numbers = o.numbers(r.number);
  Scenario of_case;
  if (scenario_of_case(of_all, o, numbers, of_case).ok()) report = compared(of_case, o, numbers, r);
}

void look_at(const Scenario& of_all, const EnsembleOptions& o, const CaseResult& r, SimulationReport& report) {
  const EnsembleCase numbers = o.numbers(r.number);
  Scenario of_case;
  report.outcome = scenario_of_case(of_all, o, numbers, of_case);
  if (report.outcome.ok()) report = looked_at(of_case, o, numbers);
}

CasesError error_of(std::span<const CaseResult* const> fit, std::span<const Judged> judged) {
  CasesError all;
  for (std::size_t i = 0; i < fit.size(); ++i) {
    const SimulationReport& r = judged[i].compared;
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
  each(2 * fit.size(), [&](std::size_t i) {
    const CaseResult& r = *fit[i / 2];
    Judged& of_case = judged[i / 2];
    const bool compares = i % 2 == 0;
    try {
      if (compares)
        compare(scenario, o, r, of_case.compared);
      else
        look_at(scenario, o, r, of_case.looked_at);
    } catch (const Failure& e) {
      if (compares)
        of_case.compared.no_error = e.diagnostic.message;
      else
        of_case.looked_at.outcome = {OutcomeKind::too_large, e.diagnostic.message, e.diagnostic.hint};
    }
  });
  report.error = error_of(fit, judged);
  report.residuals = residuals_of(fit, judged);
  if (!report.error.error && report.error.none.empty()) report.error.none = none_is_fit(o);
  if (report.residuals.cases.empty() && report.residuals.none.empty()) report.residuals.none = none_is_fit(o);
}

}  // namespace anholon
