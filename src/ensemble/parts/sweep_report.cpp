#include "ensemble/parts/sweep_report.h"

#include "base/diagnostic.h"
#include "base/json.h"
#include "ensemble/parts/judgement.h"

namespace anholon {

namespace {

// Returns a key with the counts; an empty string if no event ended a motion.
std::string events_json(const std::map<std::string, std::size_t>& events) {
  std::string list;
  for (const auto& [event, cases] : events)
    list += (list.empty() ? "\"" : ", \"") + json_escape(event) + "\": " + std::to_string(cases);
  return list.empty() ? list : ",\n  \"events\": {" + list + "}";
}

std::string report_of(const StoppedByKind& stopped, const std::string& error, const std::string& residuals,
                      std::size_t cases, std::size_t finished, const std::map<std::string, std::size_t>& events,
                      OutcomeKind outcome) {
  return "{\n  \"stopped\": " + stopped_json(stopped) + ",\n  \"error_estimate\": " + error +
         ",\n  \"residuals\": " + residuals + ",\n  \"cases\": " + std::to_string(cases) +
         ",\n  \"finished\": " + std::to_string(finished) + events_json(events) + ",\n  \"outcome\": \"" +
         name(outcome) + "\"\n}";
}

// Returns the text from one key of a judgement to the next one, as judgement_json wrote it.
std::string between(const std::string& judgement, const std::string& key, const std::string& next) {
  const std::string begin = "\"" + key + "\": ", end = ",\n  \"" + next + "\": ";
  const std::size_t from = judgement.find(begin), to = judgement.find(end);
  if (from == std::string::npos || to == std::string::npos || to < from)
    throw Failure({}, "the judgement of the folder is damaged");
  return judgement.substr(from + begin.size(), to - from - begin.size());
}

}  // namespace

std::string sweep_report_json(const StoppedByKind& stopped, const EnsembleReport& r) {
  return report_of(stopped, error_json(r.error), residuals_json(r.residuals), r.done, r.finished, r.events,
                   r.outcome.kind);
}

std::string sweep_report_json(const CollectedReport& r) {
  const bool judged = !r.judgement.empty();
  return report_of(r.stopped, judged ? between(r.judgement, "error_estimate", "residuals") : error_json({}),
                   judged ? between(r.judgement, "residuals", "text") : residuals_json({}), r.cases, r.finished,
                   r.events, OutcomeKind::finished);
}

}  // namespace anholon
