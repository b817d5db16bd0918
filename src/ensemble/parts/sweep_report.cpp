#include "ensemble/parts/sweep_report.h"

#include "base/json.h"
#include "ensemble/parts/judgement.h"

namespace anholon {

void count_stopped(StoppedByKind& stopped, std::size_t number, const Outcome& outcome) {
  if (outcome.ok()) return;
  StoppedCases& s = stopped[outcome.kind];
  if (s.count++ == 0) s.first = number, s.outcome = outcome;
}

std::string sweep_report_json(const StoppedByKind& stopped, const EnsembleReport& report) {
  std::string text = "{\n  \"stopped\": [";
  bool first = true;
  for (const auto& [kind, s] : stopped) {
    text += std::string(first ? "" : ",") + "\n    {\"outcome\": \"" + name(kind) +
            "\", \"cases\": " + std::to_string(s.count) + ", \"first\": " + std::to_string(s.first) +
            ", \"message\": \"" + json_escape(s.outcome.message) + "\", \"hint\": \"" + json_escape(s.outcome.hint) +
            "\"}";
    first = false;
  }
  return text + (first ? "" : "\n  ") + "],\n  \"error_estimate\": " + error_json(report.error) +
         ",\n  \"residuals\": " + residuals_json(report.residuals) + ",\n  \"cases\": " + std::to_string(report.done) +
         ",\n  \"finished\": " + std::to_string(report.finished) + ",\n  \"outcome\": \"" + name(report.outcome.kind) +
         "\"\n}";
}

}  // namespace anholon
