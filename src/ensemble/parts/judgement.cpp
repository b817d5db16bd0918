#include "ensemble/parts/judgement.h"

#include "base/json.h"
#include "ensemble/cases/cases_error.h"
#include "simulation/report_json.h"
#include "simulation/report_text.h"

namespace anholon {

namespace {

// Keeps the results.
class KeptCases final : public CaseSink {
 public:
  void result(const CaseResult& result) override { list.push_back(result); }
  std::vector<CaseResult> list;
};

void write_cases(JsonWriter& j, const char* key, const std::vector<std::size_t>& cases) {
  j.key(key).open_array();
  for (std::size_t k : cases) j.integer(static_cast<long long>(k));
  j.close();
}

// Indents an object for its place in another one.
std::string within(std::string text) {
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 3) text.insert(at + 1, "  ");
  return text;
}

std::string list_of(const std::vector<std::size_t>& cases) {
  std::string list;
  for (std::size_t k : cases) list += (list.empty() ? "" : ", ") + std::to_string(k);
  return list;
}

// Returns "9.1e-16 (case 3)"; the case is not named if there is only one.
std::string worst_text(const CasesResiduals& r, const CasesResiduals::Worst& worst) {
  return number_text(worst.residual, 2) +
         (r.cases.size() > 1 ? " (case " + std::to_string(worst.number) + ")" : std::string());
}

}  // namespace

std::string error_json(const CasesError& e) {
  JsonWriter j;
  j.open_object();
  if (!e.error)
    return j.key("digits").null().key("reason").string(e.none.empty() ? "not asked for" : e.none).close().text();
  write_error(j, *e.error);
  j.key("worst_case").integer(static_cast<long long>(e.worst));
  write_cases(j, "compared", e.cases);
  return within(j.close().text());
}

std::string residuals_json(const CasesResiduals& r) {
  JsonWriter j;
  j.open_object();
  if (r.cases.empty()) {
    write_cases(j, "checked", r.cases);
    return within(j.key("reason").string(r.none.empty() ? "not asked for" : r.none).close().text());
  }
  for (const auto& [key, worst] :
       {std::pair{"newton", &r.newton}, std::pair{"constraints", &r.constraints}, std::pair{"power", &r.power}}) {
    j.key(key).open_object().key("worst").number(number_text(worst->residual));
    j.key("case").integer(static_cast<long long>(worst->number)).close();
  }
  write_cases(j, "checked", r.cases);
  return within(j.close().text());
}

std::vector<std::string> judgement_lines(const EnsembleReport& r) {
  std::vector<std::string> lines;
  const std::string compared = list_of(r.error.cases);
  if (r.error.error)
    lines.push_back("digits to trust" + digits_to_trust(*r.error.error) + "; " +
                    (r.error.cases.size() == 1
                         ? "of case " + compared
                         : "of the cases " + compared + " the worst is " + std::to_string(r.error.worst)));
  else if (!r.error.none.empty())
    lines.push_back("digits to trust: not estimated, " + r.error.none);
  const CasesResiduals& all = r.residuals;
  if (!all.cases.empty())
    lines.push_back(std::string("residuals (relative) of the ") + (all.cases.size() == 1 ? "case " : "cases ") +
                    list_of(all.cases) + ": Newton's law " + worst_text(all, all.newton) + ", constraints " +
                    worst_text(all, all.constraints) + ", power balance " + worst_text(all, all.power));
  else if (!all.none.empty())
    lines.push_back("residuals: not looked at, " + all.none);
  return lines;
}

std::string judgement_json(const EnsembleReport& r) {
  JsonWriter text;
  text.open_array();
  for (const std::string& line : judgement_lines(r)) text.string(line);
  return "{\n  \"error_estimate\": " + error_json(r.error) + ",\n  \"residuals\": " + residuals_json(r.residuals) +
         ",\n  \"text\": " + text.close().text() + "\n}\n";
}

void add_report(EnsembleReport& all, const EnsembleReport& next) {
  const std::size_t before = all.done;
  all.done += next.done, all.finished += next.finished, all.in_workspaces += next.in_workspaces;
  all.seconds += next.seconds;
  all.threads = next.threads;
  for (const auto& [name, cases] : next.events) all.events[name] += cases;
  all.replaced.add(next.replaced);
  for (const auto& [name, cases] : next.without_value) all.without_value[name].add(cases);
  if (!next.outcome.ok()) all.outcome = next.outcome;
  for (std::size_t k : next.error.cases) all.error.cases.push_back(before + k);
  if (const auto& error = next.error.error) {
    if (!all.error.error || error->worst().error > all.error.error->worst().error)
      all.error.worst = before + next.error.worst;
    if (!all.error.error)
      all.error.error = error;
    else
      all.error.error->take_worse(*error);
  }
  if (!next.error.none.empty()) all.error.none = next.error.none;
  CasesResiduals& r = all.residuals;
  const auto take = [&](CasesResiduals::Worst& worst, const CasesResiduals::Worst& other) {
    if (!next.residuals.cases.empty() && (r.cases.empty() || other.residual > worst.residual))
      worst = {other.residual, before + other.number};
  };
  take(r.newton, next.residuals.newton), take(r.constraints, next.residuals.constraints);
  take(r.power, next.residuals.power);
  for (std::size_t k : next.residuals.cases) r.cases.push_back(before + k);
  if (!next.residuals.none.empty()) r.none = next.residuals.none;
}

EnsembleReport judge_piece(const SweepPiece& piece, const std::function<bool()>& cancelled) {
  const std::vector<std::size_t> numbers = cases_to_compare(piece.options->cases);
  EnsembleOptions o = *piece.options;
  o.cases = numbers.size();
  o.numbers = [&](std::size_t k) { return piece.options->numbers(numbers[k]); };
  o.cancelled = cancelled;
  o.progress = {};
  o.estimate = ErrorEstimate::never;
  KeptCases kept;
  EnsembleReport report = ensemble(*piece.scenario, o, kept);
  if (!report.outcome.ok() || piece.options->estimate == ErrorEstimate::never) return report;
  o.estimate = piece.options->estimate;
  const auto one_by_one = [&](std::size_t count, const std::function<void(std::size_t)>& f) {
    for (std::size_t k = 0; k < count && !(cancelled && cancelled()); ++k) f(k);
  };
  judge_cases(*piece.scenario, o, kept.list, one_by_one, report);
  if (cancelled && cancelled()) report.outcome = {OutcomeKind::interrupted, "interrupted", "the same command goes on"};
  const auto renumber = [&](std::vector<std::size_t>& list) {
    for (std::size_t& k : list) k = numbers[k];
  };
  renumber(report.error.cases), renumber(report.residuals.cases);
  if (report.error.error) report.error.worst = numbers[report.error.worst];
  if (!report.residuals.cases.empty())
    for (CasesResiduals::Worst* worst :
         {&report.residuals.newton, &report.residuals.constraints, &report.residuals.power})
      worst->number = numbers[worst->number];
  report.done = piece.options->cases;
  return report;
}

std::vector<std::string> notes_on_cases(const EnsembleReport& r, const Asker& asker) {
  std::vector<std::string> notes;
  if (r.replaced.cases == 1) notes.push_back("in one case: " + r.replaced.note);
  if (r.replaced.cases > 1)
    notes.push_back("in " + std::to_string(r.replaced.cases) +
                    " cases, of which these numbers are those of the first: " + r.replaced.note);
  const auto note = [&](const std::string& name, std::size_t cases, const std::string& why) {
    if (cases > 0)
      notes.push_back(name + " has no value in " + std::to_string(cases) + " of the finished cases: " + why);
  };
  for (const auto& [name, cases] : r.without_value) {
    note(name, cases.all - cases.without_polynomials, "the formula has none, or no bound, on a part of their motions");
    note(name, cases.without_polynomials,
         "BDF computed a part of their motions, which has no polynomials; " + asker.example("method", "taylor") +
             " has them everywhere");
  }
  return notes;
}

}  // namespace anholon
