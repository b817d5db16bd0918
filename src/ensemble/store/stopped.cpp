#include "ensemble/store/stopped.h"

#include <nlohmann/json.hpp>

#include "base/diagnostic.h"
#include "base/json.h"

namespace anholon {

void count_stopped(StoppedByKind& stopped, std::size_t number, const Outcome& outcome) {
  if (outcome.ok()) return;
  StoppedCases& s = stopped[outcome.kind];
  if (s.count++ == 0) s.first = number, s.outcome = outcome;
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

void add_stopped(StoppedByKind& all, const std::string& json) {
  try {
    const nlohmann::json list = nlohmann::json::parse(json);
    for (const nlohmann::json& each : list) {
      StoppedCases next{each.at("cases"), each.at("first"), {}};
      const std::string called = each.at("outcome");
      auto kind = OutcomeKind::finished;
      while (kind != OutcomeKind::too_large && called != name(kind))
        kind = static_cast<OutcomeKind>(static_cast<std::uint8_t>(kind) + 1);
      next.outcome = {kind, each.at("message"), each.at("hint")};
      StoppedCases& known = all[kind];
      next.count += known.count;
      if (known.count == 0 || next.first < known.first)
        known = std::move(next);
      else
        known.count = next.count;
    }
  } catch (const nlohmann::json::exception&) {
    throw Failure({}, "what a part tells of cases that stopped is damaged");
  }
}

}  // namespace anholon
