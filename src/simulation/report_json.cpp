#include "simulation/report_json.h"

#include <charconv>

#include <nlohmann/json.hpp>

namespace anholon {

namespace {

// ---- writing -----------------------------------------------------------------------------------

class ReportWriter {
 public:
  explicit ReportWriter(JsonWriter& j) : j_(j) {}

  void write(const SimulationReport& r) {
    residuals(r);
    if (r.second) second_opinion(*r.second);
    number("smallest_sigma_t", r.smallest_sigma_t);
    j_.key("constraints_each").open_object();
    for (const ConstraintReport& c : r.constraints_each) {
      j_.key(c.name).open_array();
      for (double x : c.residuals) j_.number(number_text(x));
      j_.close();
    }
    j_.close();
    if (r.error) {
      j_.key("error_estimate").open_object();
      error(*r.error);
      j_.close();
    } else if (!r.no_error.empty()) {
      j_.key("error_estimate").open_object().key("digits").null().key("reason").string(r.no_error).close();
    }
    if (r.looks_for_events) {
      j_.key("events");
      events(r.events);
    }
    watched("conserved", r.conserved);
    watched("monitors", r.monitors);
    notes(r);
    if (r.rigorous) rigorous(*r.rigorous);
    if (r.method.differs_from_taylor()) method(r.method);
    count("steps", r.steps);
    j_.key("order").integer(r.order);
    if (r.eliminations) count("eliminations", *r.eliminations);
    number("t", r.t);
    j_.key("outcome").string(name(r.outcome.kind));
    if (!r.outcome.ok()) j_.key("message").string(r.outcome.message).key("hint").string(r.outcome.hint);
  }

  void events(const std::vector<EventReport>& list) {
    j_.open_array();
    for (const EventReport& e : list) {
      j_.open_object().key("name").string(e.name);
      number("t", e.t);
      if (!e.changes.empty()) {
        j_.key("set").open_object();
        for (const EventReport::Change& c : e.changes) {
          j_.key(c.name).open_object();
          number("before", c.before);
          number("after", c.after);
          j_.close();
        }
        j_.close();
        number("correction", e.correction);
      }
      if (e.stop) j_.key("stop").boolean(true);
      j_.close();
    }
    j_.close();
  }

  void error(const ErrorReport& e) {
    const KindError& worst = e.worst();
    of_kind(worst);
    j_.key("kinds").open_array();
    for (const KindError& k : e.kinds) {
      j_.open_object().key("kind").string(name(k.kind));
      of_kind(k);
      j_.close();
    }
    j_.close();
    if (e.lost) {
      number("lost_from", *e.lost);
      j_.key("lost_of").string(e.lost_of);
    }
    if (e.until) {
      number("until", *e.until);
      j_.key("reason").string("the second run stopped: " + e.stopped);
    }
    if (!e.undetermined.empty()) {
      j_.key("undetermined").open_array();
      for (const std::string& name : e.undetermined) j_.string(name);
      j_.close();
    }
    j_.key("means").string(e.means);
  }

 private:
  void number(const char* key, double x) { j_.key(key).number(number_text(x)); }
  void count(const char* key, std::size_t n) { j_.key(key).integer(static_cast<long long>(n)); }
  void number(const char* key, const WrittenNumber& x) { j_.key(key).number(json_number(x.text())); }

  void of_kind(const KindError& k) {
    j_.key("digits").integer(k.digits);
    number("error", k.error);
    j_.key("of").string(k.of);
    number("t", k.t);
  }

  void residuals(const SimulationReport& r) {
    j_.key("residuals").open_object();
    number("newton", r.newton);
    number("projected", r.projected);
    number("constraints", r.constraints_kept);
    number("constraints_before_projection", r.constraints);
    number("power", r.power);
    number("smallest_sigma", r.smallest_sigma);
    if (r.rows_looked_at > 0) count("rows", r.rows_looked_at);
    j_.close();
  }

  void second_opinion(const SecondOpinion& o) {
    j_.key("second_opinion").open_object().key("integrator").string(name(o.integrator)).key("form").string(o.form);
    number("difference", o.difference);
    j_.key("of").string(o.of);
    number("t", o.t);
    count("steps", o.steps);
    count("evaluations", o.evaluations);
    j_.close();
  }

  void watched(const char* key, const std::vector<WatchedReport>& list) {
    if (list.empty()) return;
    j_.key(key).open_object();
    for (const WatchedReport& w : list) {
      j_.key(w.name).open_object();
      number("first", w.first);
      number("last", w.last);
      number("min", w.least);
      number("max", w.greatest);
      number("largest_change", w.largest_change);
      if (w.times > 0) count("times", w.times);
      j_.close();
    }
    j_.close();
  }

  void notes(const SimulationReport& r) {
    if (!r.notes.empty()) {
      j_.key("notes").open_array();
      for (const std::string& n : r.notes) j_.string(n);
      j_.close();
    }
    if (r.warnings.empty()) return;
    j_.key("warnings").open_array();
    for (const Warning& w : r.warnings)
      j_.open_object().key("message").string(w.message).key("hint").string(w.hint).close();
    j_.close();
  }

  void rigorous(const RigorousReport& r) {
    j_.key("rigorous").open_object().key("times");
    if (r.times)
      j_.integer(static_cast<long long>(*r.times));
    else
      j_.string("all");
    for (const auto& [key, bound] : {std::pair{"newton", &r.newton},
                                     {"projected", &r.projected},
                                     {"constraints", &r.constraints},
                                     {"joints", &r.joints}})
      j_.key(key).number(*bound);
    if (r.kink)
      j_.key("kink")
          .open_object()
          .key("formula")
          .string(r.kink->formula)
          .key("t")
          .number(number_text(r.kink->t))
          .close();
    j_.key("bits").integer(r.bits).close();
  }

  void method(const MethodReport& r) {
    j_.key("method").open_object().key("asked").string(name(r.asked)).key("last").string(name(r.last));
    count("taylor_steps", r.taylor_steps);
    count("steps", r.steps);
    count("refused", r.refused);
    count("evaluations", r.evaluations);
    count("trials", r.trials);
    count("trial_evaluations", r.trial_evaluations);
    if (!r.turns.empty()) {
      j_.key("turns").open_array();
      for (const MethodReport::Turn& turn : r.turns) {
        j_.open_object();
        number("t", turn.t);
        j_.key("to").string(name(turn.to)).key("why").string(turn.why).close();
      }
      j_.close();
    }
    j_.close();
  }

  JsonWriter& j_;
};

// ---- reading -----------------------------------------------------------------------------------

using Json = nlohmann::ordered_json;

// Builds the document; a number that does not fit a double becomes its text.
class DigitKeeper : public nlohmann::detail::json_sax_dom_parser<Json> {
 public:
  explicit DigitKeeper(Json& document) : json_sax_dom_parser(document, false) {}
  bool number_float(double value, const std::string& written) {
    if (says_all(written, value)) return json_sax_dom_parser::number_float(value, written);
    std::string digits = written;
    return string(digits);
  }
};

// An object of the report. A key that is missing, or has a value of another kind, reads as empty, zero or NaN.
class Fields {
 public:
  explicit Fields(const Json& j) : j_(j.is_object() ? j : kNone) {}
  explicit Fields(const Json&&) = delete;

  const Json& at(const char* key) const {
    const auto it = j_.find(key);
    return it == j_.end() ? kNone : *it;
  }
  bool has(const char* key) const { return j_.contains(key); }
  Fields object(const char* key) const { return Fields(at(key)); }
  std::string text(const char* key) const { return at(key).is_string() ? at(key).get<std::string>() : std::string(); }
  WrittenNumber written(const char* key) const {
    const Json& x = at(key);
    WrittenNumber n;
    if (x.is_number()) n.value = x.get<double>();
    if (x.is_string()) {
      n.digits = x.get<std::string>();
      parse_number(n.digits, n.value);
    }
    return n;
  }
  double number(const char* key) const { return written(key).value; }
  std::size_t count(const char* key) const {
    return at(key).is_number_unsigned() ? at(key).get<std::size_t>() : std::size_t{0};
  }
  int integer(const char* key) const { return at(key).is_number_integer() ? at(key).get<int>() : 0; }
  const Json& json() const { return j_; }

 private:
  static const Json kNone;
  const Json& j_;
};
const Json Fields::kNone;

template <class F>
void each(const Json& list, F f) {
  if (list.is_array())
    for (const Json& j : list) f(Fields(j));
}

KindError kind_error(const Fields& f) {
  KindError k{ColumnKind::coordinate, f.number("error"), f.integer("digits"), f.text("of"), f.number("t")};
  for (int kind = 0; kind <= static_cast<int>(ColumnKind::event_time); ++kind)
    if (f.text("kind") == name(static_cast<ColumnKind>(kind))) k.kind = static_cast<ColumnKind>(kind);
  return k;
}

ErrorReport error_report(const Fields& f) {
  ErrorReport e;
  each(f.at("kinds"), [&](const Fields& k) { e.kinds.push_back(kind_error(k)); });
  if (e.kinds.empty()) e.kinds.push_back(kind_error(f));
  e.means = f.text("means");
  if (const auto& list = f.at("undetermined"); list.is_array())
    for (const Json& n : list)
      if (n.is_string()) e.undetermined.push_back(n.get<std::string>());
  if (f.has("lost_from")) e.lost = f.number("lost_from"), e.lost_of = f.text("lost_of");
  if (f.has("until")) {
    constexpr std::string_view kStopped = "the second run stopped: ";
    e.until = f.number("until");
    e.stopped = f.text("reason");
    if (e.stopped.starts_with(kStopped)) e.stopped.erase(0, kStopped.size());
  }
  return e;
}

EventReport event(const Fields& f) {
  EventReport e{f.text("name"), f.written("t"), {}, f.has("correction") ? f.number("correction") : 0, false};
  const Fields set = f.object("set");
  for (const auto& [name, change] : set.json().items()) {
    const Fields c(change);
    e.changes.push_back({name, c.written("before"), c.written("after")});
  }
  e.stop = f.at("stop").is_boolean() && f.at("stop").get<bool>();
  return e;
}

std::vector<WatchedReport> watched(const Fields& list) {
  std::vector<WatchedReport> all;
  for (const auto& [name, value] : list.json().items()) {
    const Fields w(value);
    all.push_back(
        {name, w.written("first"), w.written("last"), w.written("min"), w.written("max"), w.number("largest_change")});
    if (w.has("times")) all.back().times = w.count("times");
  }
  return all;
}

MethodReport method_report(const Fields& f) {
  MethodReport m;
  m.asked = find_method(f.text("asked")).value_or(Method::automatic);
  m.last = find_method(f.text("last")).value_or(Method::taylor);
  m.taylor_steps = f.count("taylor_steps"), m.steps = f.count("steps"), m.refused = f.count("refused");
  m.evaluations = f.count("evaluations"), m.trials = f.count("trials");
  m.trial_evaluations = f.count("trial_evaluations");
  each(f.at("turns"), [&](const Fields& t) {
    m.turns.push_back({t.number("t"), find_method(t.text("to")).value_or(Method::taylor), t.text("why")});
  });
  return m;
}

std::optional<OutcomeKind> find_outcome(const std::string& text) {
  for (int k = 0; k <= static_cast<int>(OutcomeKind::too_large); ++k)
    if (text == name(static_cast<OutcomeKind>(k))) return static_cast<OutcomeKind>(k);
  return std::nullopt;
}

SecondOpinion second_opinion(const Fields& f) {
  SecondOpinion o;
  o.integrator = find_method(f.text("integrator"), MethodInfo::Use::second_opinion).value_or(Method::cvode);
  o.form = f.text("form"), o.difference = f.number("difference"), o.of = f.text("of"), o.t = f.number("t");
  o.steps = f.count("steps"), o.evaluations = f.count("evaluations");
  return o;
}

RigorousReport rigorous_report(const Fields& f) {
  RigorousReport r;
  if (f.at("times").is_number()) r.times = f.count("times");
  r.newton = f.written("newton").text(), r.projected = f.written("projected").text();
  r.constraints = f.written("constraints").text(), r.joints = f.written("joints").text();
  r.bits = f.integer("bits");
  if (f.has("kink")) r.kink = RigorousReport::Kink{f.object("kink").text("formula"), f.object("kink").number("t")};
  return r;
}

SimulationReport report(const Fields& f, OutcomeKind kind) {
  SimulationReport r;
  r.model = f.text("model"), r.form = f.text("form");
  r.outcome = {kind, f.text("message"), f.text("hint")};
  const Fields residuals = f.object("residuals");
  r.newton = residuals.number("newton"), r.projected = residuals.number("projected");
  r.constraints_kept = residuals.number("constraints");
  r.constraints = residuals.number("constraints_before_projection");
  r.power = residuals.number("power"), r.smallest_sigma = residuals.number("smallest_sigma");
  if (residuals.has("rows")) r.rows_looked_at = residuals.count("rows");
  r.smallest_sigma_t = f.number("smallest_sigma_t"), r.t = f.number("t");
  r.steps = f.count("steps"), r.order = f.integer("order");
  if (f.has("eliminations")) r.eliminations = f.count("eliminations");
  for (const auto& [name, list] : f.object("constraints_each").json().items()) {
    ConstraintReport& c = r.constraints_each.emplace_back();
    c.name = name;
    if (!list.is_array()) continue;
    for (const Json& x : list)
      c.residuals.push_back(x.is_number() ? x.get<double>() : std::numeric_limits<double>::quiet_NaN());
  }
  if (const Fields e = f.object("error_estimate"); e.at("digits").is_number())
    r.error = error_report(e);
  else
    r.no_error = e.text("reason");
  if (f.at("events").is_array()) {
    r.looks_for_events = true;
    each(f.at("events"), [&](const Fields& e) { r.events.push_back(event(e)); });
  }
  r.conserved = watched(f.object("conserved")), r.monitors = watched(f.object("monitors"));
  if (f.at("notes").is_array())
    for (const Json& n : f.at("notes"))
      if (n.is_string()) r.notes.push_back(n.get<std::string>());
  each(f.at("warnings"), [&](const Fields& w) { r.warnings.push_back({w.text("message"), w.text("hint")}); });
  if (f.has("rigorous")) r.rigorous = rigorous_report(f.object("rigorous"));
  if (f.has("method")) r.method = method_report(f.object("method"));
  if (f.has("second_opinion")) r.second = second_opinion(f.object("second_opinion"));
  return r;
}

}  // namespace

std::string report_json(const SimulationReport& r) {
  JsonWriter j;
  j.open_object().key("model").string(r.model).key("form").string(r.form);
  ReportWriter(j).write(r);
  return j.close().text();
}

std::string events_json(const std::vector<EventReport>& events) {
  JsonWriter j;
  ReportWriter(j).events(events);
  return j.text();
}

std::vector<EventReport> read_events(const std::string& json) {
  std::vector<EventReport> events;
  Json j;
  DigitKeeper keeper(j);
  if (Json::sax_parse(json, &keeper)) each(j, [&](const Fields& e) { events.push_back(event(e)); });
  return events;
}

std::optional<SimulationReport> read_report(const std::string& json) {
  Json j;
  DigitKeeper keeper(j);
  if (!Json::sax_parse(json, &keeper)) return std::nullopt;
  const Fields fields(j);
  const std::optional<OutcomeKind> kind = find_outcome(fields.text("outcome"));
  if (!kind) return std::nullopt;
  return report(fields, *kind);
}

void write_error(JsonWriter& j, const ErrorReport& error) { ReportWriter(j).error(error); }

}  // namespace anholon
