#include "report/run_report.h"

#include <nlohmann/json.hpp>

namespace anholon {

namespace {

using Json = nlohmann::json;

// A field, or an empty one of the kind.
Json object(const Json& j, const char* key) { return j.contains(key) && j[key].is_object() ? j[key] : Json::object(); }
Json array(const Json& j, const char* key) { return j.contains(key) && j[key].is_array() ? j[key] : Json::array(); }
std::string text(const Json& j, const char* key) {
  return j.contains(key) && j[key].is_string() ? j[key].get<std::string>() : "";
}
std::string number(const Json& j, const char* key) {
  return !j.contains(key) || j[key].is_null() ? "–" : j[key].is_string() ? j[key].get<std::string>() : j[key].dump();
}

// "coordinates 13, velocities 12, by a second run …"; of older files one number.
std::string digits(const Json& estimate) {
  const std::string reason = text(estimate, "reason");
  if (!estimate.contains("digits") || estimate["digits"].is_null()) return reason.empty() ? "not estimated" : reason;
  std::string list;
  const Json kinds = array(estimate, "kinds");
  for (const Json& k : kinds) list += (list.empty() ? "" : ", ") + text(k, "kind") + " " + number(k, "digits");
  if (list.empty()) list = number(estimate, "digits");
  if (estimate.contains("until")) list += ", up to t = " + number(estimate, "until") + " (" + reason + ")";
  return list + ", by " + text(estimate, "means");
}

void methods(const Json& j, std::set<std::string>& list) {
  const Json method = object(j, "method");
  list.insert(text(method, "last"));
  const Json turns = array(method, "turns");
  for (const Json& turn : turns) list.insert(text(turn, "to"));
  list.insert(text(object(j, "second_opinion"), "integrator"));
}

RunReport::Event event(const Json& j) {
  RunReport::Event e{text(j, "name"), number(j, "t"), {}};
  const Json set = object(j, "set");
  for (const auto& [name, change] : set.items())
    e.changes.push_back({name, number(change, "before"), number(change, "after")});
  return e;
}

}  // namespace

RunReport read_run_report(const std::string& json) {
  Json j = Json::parse(json, nullptr, false);
  if (!j.is_object()) j = Json::object();
  const Json residuals = object(j, "residuals");
  RunReport r;
  r.outcome = text(j, "outcome"), r.message = text(j, "message"), r.hint = text(j, "hint");
  r.newton = number(residuals, "newton"), r.projected = number(residuals, "projected"),
  r.power = number(residuals, "power");
  r.constraints = number(residuals, "constraints"),
  r.before_projection = number(residuals, "constraints_before_projection");
  r.smallest_sigma = number(residuals, "smallest_sigma"), r.smallest_sigma_t = number(j, "smallest_sigma_t");
  r.steps = number(j, "steps"), r.order = number(j, "order");
  r.digits = digits(object(j, "error_estimate"));
  for (const char* list : {"conserved", "monitors"}) {
    const Json all = object(j, list);
    for (const auto& [name, w] : all.items())
      r.watched.push_back({name, number(w, "first"), number(w, "last"), number(w, "min"), number(w, "max"),
                           number(w, "largest_change")});
  }
  const Json events = array(j, "events"), warnings = array(j, "warnings");
  for (const Json& e : events) r.events.push_back(event(e));
  for (const Json& w : warnings) r.warnings.push_back({text(w, "message"), text(w, "hint")});
  methods(j, r.methods);
  return r;
}

}  // namespace anholon
