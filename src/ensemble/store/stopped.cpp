#include "ensemble/store/stopped.h"

#include "base/json.h"

namespace anholon {

void count_stopped(StoppedByKind& stopped, std::size_t number, const Outcome& outcome) {
  if (outcome.ok()) return;
  StoppedCases& s = stopped[outcome.kind];
  if (s.count++ == 0) s.first = number, s.outcome = outcome;
}

std::string stopped_note(OutcomeKind kind, const StoppedCases& stopped) {
  return std::string("stopped (") + name(kind) + "), " + std::to_string(stopped.count) +
         (stopped.count == 1 ? " case" : " cases") + ", first case " + std::to_string(stopped.first) + ": " +
         stopped.outcome.message + (stopped.outcome.hint.empty() ? "" : "\nhint: " + stopped.outcome.hint);
}

std::string stopped_json(const StoppedByKind& stopped) {
  std::string text = "[";
  bool first = true;
  for (const auto& [kind, s] : stopped) {
    text += std::string(first ? "" : ",") + "\n    {\"outcome\": \"" + name(kind) +
            "\", \"cases\": " + std::to_string(s.count) + ", \"first\": " + std::to_string(s.first) +
            ", \"message\": \"" + json_escape(s.outcome.message) + "\", \"hint\": \"" + json_escape(s.outcome.hint) +
            "\"}";
    first = false;
  }
  return text + (first ? "" : "\n  ") + "]";
}

}  // namespace anholon
