#include "ensemble/cases_error.h"

#include "ensemble/case_scenario.h"
#include "ensemble/columns.h"
#include "integrate/series/kinks.h"
#include "observe/estimate.h"

namespace anholon {

namespace {

// Whether a kernel makes the motions of a model, so that one with other roundings tells of their errors.
bool made_by_kernel(const Scenario& s) {
  const Program p = program(s.system, s.structure);
  return s.model->events.empty() && s.model->bounds.empty() && no_plan(p).empty() &&
         !may_have_kinks(p.tape, p.tape.main_end);
}

SimulationReport compared(const Scenario& of_all, const EnsembleOptions& o, const CaseResult& r) {
  SimulationReport report;
  const EnsembleCase numbers = o.numbers(r.number);
  Scenario of_case;
  if (report.outcome = scenario_of_case(of_all, o, numbers, of_case); !report.outcome.ok()) return report;
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

SimulationReport looked_at(const Scenario& of_all, const EnsembleOptions& o, std::size_t number) {
  SimulationReport report;
  const EnsembleCase numbers = o.numbers(number);
  Scenario of_case;
  if (report.outcome = scenario_of_case(of_all, o, numbers, of_case); !report.outcome.ok()) return report;
  SimulationOptions options = options_of_case(o, numbers);
  options.to = numbers.to ? *numbers.to : o.to;
  options.order = o.order;
  options.method = o.method;
  options.kernel = o.kernel;
  NoRows rows;
  return simulate(of_case, options, rows);
}

}  // namespace

std::vector<std::size_t> cases_to_compare(std::size_t cases) {
  constexpr std::size_t kFew = 3, kMany = 8, kManyCases = 20'000;
  const std::size_t count = std::min(cases, cases < kManyCases ? kFew : kMany);
  std::vector<std::size_t> list;
  for (std::size_t k = 0; k < count; ++k) list.push_back(count == 1 ? 0 : k * (cases - 1) / (count - 1));
  return list;
}

CasesError cases_error(const Scenario& scenario, const EnsembleOptions& o, std::span<const CaseResult> results,
                       const Each& each) {
  CasesError all;
  const std::vector<const CaseResult*> fit = fit_for_judgement(o, results);
  std::vector<SimulationReport> reports(fit.size());
  each(fit.size(), [&](std::size_t i) {
    try {
      reports[i] = compared(scenario, o, *fit[i]);
    } catch (const Failure& e) {
      reports[i].no_error = e.diagnostic.message;
    }
  });
  for (std::size_t i = 0; i < fit.size(); ++i) {
    const SimulationReport& r = reports[i];
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
  if (!all.error && all.none.empty()) all.none = none_is_fit(o);
  return all;
}

CasesResiduals cases_residuals(const Scenario& scenario, const EnsembleOptions& o, std::span<const CaseResult> results,
                               const Each& each) {
  CasesResiduals all;
  const std::vector<const CaseResult*> fit = fit_for_judgement(o, results);
  std::vector<SimulationReport> reports(fit.size());
  each(fit.size(), [&](std::size_t i) {
    try {
      reports[i] = looked_at(scenario, o, fit[i]->number);
    } catch (const Failure& e) {
      reports[i].outcome = {OutcomeKind::too_large, e.diagnostic.message, e.diagnostic.hint};
    }
  });
  for (std::size_t i = 0; i < fit.size(); ++i) {
    const SimulationReport& r = reports[i];
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
  if (all.cases.empty() && all.none.empty()) all.none = none_is_fit(o);
  return all;
}

}  // namespace anholon
