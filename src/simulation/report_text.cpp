#include "simulation/report_text.h"

namespace anholon {

std::string small(double x) { return number_text(x, 3); }

std::string digits_to_trust(const ErrorReport& e) {
  std::string list;
  for (const KindError& k : e.kinds)
    list += (list.empty() ? "" : ", ") + std::string(name(k.kind)) + " " + std::to_string(k.digits);
  const KindError& worst = e.worst();
  const std::string until =
      e.until ? ", up to t = " + number_text(*e.until, 6) + ", where the second run stopped (" + e.stopped + ")" : "";
  return until + ": " + list + " (worst: " + worst.of + ", error " + small(worst.error) +
         (worst.kind == ColumnKind::event_time ? "" : " of its largest value") + ", at t = " + number_text(worst.t, 6) +
         "; by " + e.means + ")" + not_vouched_for(e);
}

std::string not_vouched_for(const ErrorReport& e) {
  if (e.undetermined.empty()) return {};
  std::string list;
  for (const std::string& name : e.undetermined) list += (list.empty() ? "" : ", ") + name;
  return ", not for " + list + ", which the equations do not determine";
}

}  // namespace anholon
