#include "ensemble/ending.h"

#include "base/outcome.h"

namespace anholon {

namespace {

std::string by_events(const std::map<std::string, std::size_t>& events) {
  std::string list;
  for (const auto& [event, cases] : events)
    list += (list.empty() ? "" : ", ") + std::to_string(cases) + " by event " + event;
  return list.empty() ? list : " (" + list + ")";
}

}  // namespace

std::string ending(std::string_view outcome, std::string_view event) {
  if (event.empty() || outcome != name(OutcomeKind::finished)) return std::string(outcome);
  return "event " + std::string(event);
}

std::string list_of_endings(const std::map<std::string, std::size_t>& outcomes,
                            const std::map<std::string, std::size_t>& events) {
  std::string list;
  for (const auto& [outcome, cases] : outcomes) {
    list += (list.empty() ? "" : ", ") + std::to_string(cases) + " " + outcome;
    if (outcome == name(OutcomeKind::finished)) list += by_events(events);
  }
  return list;
}

}  // namespace anholon
