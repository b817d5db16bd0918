#include "observe/supports.h"

#include <algorithm>
#include <cmath>

#include "numeric/number.h"
#include "observe/translations.h"

namespace anholon {

std::vector<Support> supports(const Scenario& s) {
  const Model& model = *s.model;
  const auto found = translations(s);
  if (!found || !found->up || found->sideways.empty()) return {};
  const Translation& up = *found->up;
  const Triple& gravity = found->gravity;
  std::vector<Support> list;
  for (std::size_t k = 0; k < found->geometric.size(); ++k) {
    const std::size_t r = found->geometric[k];
    const bool single = model.constraints[r].name.find('.') == std::string::npos,
               holds = std::find(s.redundant.begin(), s.redundant.end(), r) == s.redundant.end();
    const double rate = up.residuals[k];
    if (!single || !holds || model.constraints[r].by || !std::isfinite(rate) || rate == 0) continue;
    // The power of the constraint for a velocity of one along the coordinate, against gravity.
    list.push_back({r, -rate * dot(up.along, gravity) / (dot(up.along, up.along) * norm(gravity))});
  }
  return list;
}

static const std::string kPulls = "' looks like a floor and pulls down from t = ", kAtMost = ", at most with ";

bool is_of_support(const std::string& note) { return note.find(kPulls) != std::string::npos; }

std::string without_size_of_pull(std::string note) {
  const std::size_t at = note.find(kAtMost), end = note.find(": ", at);
  if (at != std::string::npos && end != std::string::npos) note.erase(at, end - at);
  return note;
}

void SupportWatch::Load::see(double t, double force) {
  if (!any || force < least) least = force, least_t = t;
  if (!any || force > largest) largest = force;
  any = true;
  // Round-off of a support that bears nothing is no pull.
  constexpr double kNothing = 1e-9;
  if (!pulls && force < 0 && -force > kNothing * std::abs(largest)) pulls = t;
}

std::vector<std::string> SupportWatch::notes() const {
  std::vector<std::string> list;
  for (const Load& l : loads_) {
    if (!l.pulls) continue;
    list.push_back(
        "constraint '" + s_.model->constraints[l.support.constraint].name + kPulls + number_text(*l.pulls, 6) + " on" +
        kAtMost + number_text(-l.least, 3) + " at t = " + number_text(l.least_t, 6) +
        ": a body that may lift would leave it; one_sided = true in the constraint lets it open, with the equation " +
        s_.model->constraints[l.support.constraint].equation +
        (l.support.upwards > 0 ? "" : " turned round, the larger side on the left"));
  }
  return list;
}

}  // namespace anholon
