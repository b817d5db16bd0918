#include "cli/simulation_json.h"

#include "cli/method.h"
#include "result/table.h"

namespace anholon::cli {

std::string small(double x) { return number_text(x, 3); }

ErrorEstimate error_estimate(const Options& o) {
  return o.error_estimate == "always"  ? ErrorEstimate::always
         : o.error_estimate == "never" ? ErrorEstimate::never
                                       : ErrorEstimate::short_runs;
}

std::string digits_to_trust(const ErrorReport& e) {
  std::string list;
  for (const KindError& k : e.kinds)
    list += (list.empty() ? "" : ", ") + std::string(name(k.kind)) + " " + std::to_string(k.digits);
  const KindError& worst = e.worst();
  const std::string until =
      e.until ? ", up to t = " + number_text(*e.until, 6) + ", where the second run stopped (" + e.stopped + ")" : "";
  return until + ": " + list + " (worst: " + worst.of + ", error " + small(worst.error) +
         (worst.kind == ColumnKind::event_time ? "" : " of its largest value") + ", at t = " + number_text(worst.t, 6) +
         "; by " + e.means + ")";
}

void write_error(JsonWriter& j, const ErrorReport& e) {
  const KindError& worst = e.worst();
  j.key("digits")
      .integer(worst.digits)
      .key("error")
      .number(small(worst.error))
      .key("of")
      .string(worst.of)
      .key("t")
      .number(number_text(worst.t, 6));
  j.key("kinds").open_array();
  for (const KindError& k : e.kinds)
    j.open_object()
        .key("kind")
        .string(name(k.kind))
        .key("digits")
        .integer(k.digits)
        .key("error")
        .number(small(k.error))
        .key("of")
        .string(k.of)
        .key("t")
        .number(number_text(k.t, 6))
        .close();
  j.close();
  if (e.lost) j.key("lost_from").number(number_text(*e.lost, 6));
  if (e.until)
    j.key("until").number(number_text(*e.until, 6)).key("reason").string("the second run stopped: " + e.stopped);
  j.key("means").string(e.means);
}

namespace {

void write_watched(JsonWriter& j, const char* key, const std::vector<WatchedReport>& list) {
  if (list.empty()) return;
  j.key(key).open_object();
  for (const WatchedReport& w : list) {
    j.key(w.name).open_object();
    for (const auto& [name, value] :
         {std::pair{"first", &w.first}, {"last", &w.last}, {"min", &w.least}, {"max", &w.greatest}})
      j.key(name).number(*value);
    j.key("largest_change").number(small(w.largest_change)).close();
  }
  j.close();
}

// What stands behind the rows.
void write_report(JsonWriter& j, const Scenario& s, const SimulationReport& r) {
  j.key("residuals").open_object();
  for (const auto& [name, value] : {std::pair{"newton", r.newton},
                                    {"projected", r.projected},
                                    {"constraints", r.constraints_kept},
                                    {"constraints_before_projection", r.constraints},
                                    {"power", r.power},
                                    {"smallest_sigma", r.smallest_sigma}})
    j.key(name).number(small(value));
  j.close();
  if (r.second) {
    j.key("second_opinion")
        .open_object()
        .key("integrator")
        .string(name(r.second->integrator))
        .key("form")
        .string(r.second->form);
    j.key("difference")
        .number(small(r.second->difference))
        .key("of")
        .string(r.second->of)
        .key("t")
        .number(number_text(r.second->t));
    j.key("steps")
        .integer(static_cast<long long>(r.second->steps))
        .key("evaluations")
        .integer(static_cast<long long>(r.second->evaluations))
        .close();
  }
  j.key("smallest_sigma_t").number(r.smallest_sigma_t.empty() ? "nan" : r.smallest_sigma_t);
  j.key("constraints_each").open_object();
  for (const ConstraintReport& c : r.constraints_each) {
    j.key(c.name).open_array();
    for (double x : c.residuals) j.number(small(x));
    j.close();
  }
  j.close();
  if (r.error) {
    j.key("error_estimate").open_object();
    write_error(j, *r.error);
    j.close();
  } else if (!r.no_error.empty()) {
    j.key("error_estimate").open_object().key("digits").null().key("reason").string(r.no_error).close();
  }
  if (!s.model->events.empty()) {
    j.key("events").open_array();
    for (const EventReport& e : r.events) {
      j.open_object().key("name").string(e.name).key("t").number(e.t);
      if (!e.changes.empty()) {
        j.key("set").open_object();
        for (const auto& c : e.changes)
          j.key(c.name).open_object().key("before").number(c.before).key("after").number(c.after).close();
        j.close().key("correction").number(small(e.correction));
      }
      if (e.stop) j.key("stop").boolean(true);
      j.close();
    }
    j.close();
  }
  write_watched(j, "conserved", r.conserved);
  write_watched(j, "monitors", r.monitors);
  if (!r.notes.empty()) {
    j.key("notes").open_array();
    for (const std::string& n : r.notes) j.string(n);
    j.close();
  }
  if (!r.warnings.empty()) {
    j.key("warnings").open_array();
    for (const Warning& w : r.warnings)
      j.open_object().key("message").string(w.message).key("hint").string(w.hint).close();
    j.close();
  }
  if (r.rigorous) {
    j.key("rigorous").open_object();
    j.key("times");
    if (r.rigorous->times)
      j.integer(static_cast<long long>(*r.rigorous->times));
    else
      j.string("all");
    j.key("newton")
        .number(r.rigorous->newton)
        .key("projected")
        .number(r.rigorous->projected)
        .key("constraints")
        .number(r.rigorous->constraints)
        .key("joints")
        .number(r.rigorous->joints);
    j.key("bits").integer(r.rigorous->bits);
    j.close();
  }
  write_method(j, r.method);
  j.key("steps").integer(static_cast<long long>(r.steps));
  j.key("order").integer(r.order);
  if (s.system.form->eliminates()) j.key("eliminations").integer(static_cast<long long>(r.eliminations));
  j.key("t").number(r.t);
  j.key("outcome").string(name(r.outcome.kind));
  if (!r.outcome.ok()) j.key("message").string(r.outcome.message).key("hint").string(r.outcome.hint);
}

}  // namespace

std::string simulation_json(const Scenario& s, const MemorySink& rows, const SimulationReport& r) {
  JsonWriter j;
  j.open_object();
  j.key("model").string(s.model->title);
  j.key("form").string(s.system.form->name);
  j.key("columns").open_array();
  for (const std::string& n : rows.names()) j.string(n);
  j.close();
  j.key("rows").open_array();
  for (const auto& row : rows.rows()) {
    j.open_array();
    for (const std::string& v : row) j.number(json_number(v));
    j.close();
  }
  j.close();
  write_report(j, s, r);
  j.close();
  return j.text() + "\n";
}

std::string report_json(const Scenario& s, const SimulationReport& r) {
  JsonWriter j;
  j.open_object();
  j.key("model").string(s.model->title);
  j.key("form").string(s.system.form->name);
  write_report(j, s, r);
  j.close();
  return j.text();
}

}  // namespace anholon::cli
