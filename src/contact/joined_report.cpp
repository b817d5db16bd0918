#include "contact/joined_report.h"

#include <algorithm>
#include <cctype>
#include <functional>

#include "motion/stiff_method.h"
#include "observe/floors/supports.h"

namespace anholon {

// True if two warnings differ at most in the time that they name.
static bool same_but_time(const Warning& a, const Warning& b) {
  const auto without_time = [](const std::string& text) {
    const std::size_t at = text.find(" at t = "), end = text.find(':', at);
    return at == std::string::npos ? text : text.substr(0, at) + (end == std::string::npos ? "" : text.substr(end));
  };
  return without_time(a.message) == without_time(b.message);
}

static bool is_of_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.'; }

// The model of a mode has constraints NAME.gap and NAME.slip1, …, inputs NAME.n and NAME.t1, … that keep them, and two
// events of a change that differ by a prime. A user knows the contact, the forces lambda.NAME and lambda.NAME.t1, and
// the events; their names replace those of the model. Returns true if the text has changed.
static bool put_known_names(const std::string& contact, std::string& text) {
  const std::string given = text, lambda = "lambda.", monitor = "monitor '", name = contact + ".";
  for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
    std::size_t begin = at;
    const bool force = at >= lambda.size() && text.compare(at - lambda.size(), lambda.size(), lambda) == 0;
    if (force) begin -= lambda.size();
    if (begin > 0 && is_of_name(text[begin - 1])) continue;
    if (begin >= monitor.size() && text.compare(begin - monitor.size(), monitor.size(), monitor) == 0) continue;
    const bool quoted = begin > 0 && text[begin - 1] == '\'';
    std::size_t end = at + name.size();
    while (end < text.size() && is_of_name(text[end])) ++end;
    const std::string what = text.substr(at + name.size(), end - at - name.size());
    const bool numbered = !what.empty() && (what.back() == '1' || what.back() == '2');
    const std::string of = force || quoted ? contact : lambda + contact;
    const std::string constraint = "constraint '";
    const bool of_constraint = quoted && text.substr(0, begin).ends_with(constraint);
    if (of_constraint && (what == "gap" || what.starts_with("slip"))) {
      begin -= constraint.size();
      text.replace(begin, end - begin, (what == "gap" ? "contact '" : "slip of the contact '") + contact);
    } else if (what == "gap" || what == "n")
      text.replace(at, end - at, of);
    else if (numbered && (what.starts_with("slip") || (what.starts_with("t") && what.size() == 2)))
      text.replace(at, end - at, of + ".t" + what.back());
    else
      while (quoted && text.compare(end, 2, "\'\'") == 0) text.erase(end, 1);
    at = text.find(contact, begin);
  }
  return text != given;
}

// Joins watched numbers; the change is that from the start of the whole motion.
static void join(std::vector<WatchedReport>& all, const std::vector<WatchedReport>& segment) {
  for (const WatchedReport& m : segment) {
    const auto known = std::find_if(all.begin(), all.end(), [&](const WatchedReport& o) { return o.name == m.name; });
    if (known == all.end()) {
      all.push_back(m);
      continue;
    }
    known->last = m.last;
    if (m.least.value < known->least.value) known->least = m.least;
    if (m.greatest.value > known->greatest.value) known->greatest = m.greatest;
    known->size = std::max(known->size, m.size);
    known->times += m.times;
    const double change = std::max(known->greatest.value - known->first.value, known->first.value - known->least.value);
    known->largest_change =
        std::max({known->largest_change, m.largest_change, known->size > 0 ? change / known->size : 0});
  }
}

JoinedReport::JoinedReport(const Model& model, const std::vector<Contact>& contacts) {
  for (const Contact& c : contacts) contacts_.push_back(c.name);
  all_.model = model.title;
  all_.looks_for_events = true;
}

bool JoinedReport::add(const SimulationReport& r, const std::map<std::string, ModeEvent>& contacts) {
  bool goes_on = true;
  power_miss_ = std::max(power_miss_, r.power * (r.turned_over > 0 ? r.turned_over : 1));
  // True for a warning about the change within one mode; the change of the whole motion is reported at the end.
  const auto of_its_own = [&](const Warning& w) {
    return std::any_of(r.conserved.begin(), r.conserved.end(), [&](const WatchedReport& c) {
      return w.message == not_conserved(c.name, c.largest_change).message;
    });
  };
  const auto named = [&](const Warning& w) {
    return std::any_of(all_.warnings.begin(), all_.warnings.end(),
                       [&](const Warning& o) { return same_but_time(o, w); });
  };
  for (const std::string& note : r.notes) {
    // A constraint is noted once, with the time of its first pull.
    const std::string text = without_size_of_pull(note), name = text.substr(0, text.find(" from t = "));
    if (is_of_support(note) && std::none_of(floors_.begin(), floors_.end(),
                                            [&](const std::string& known) { return known.rfind(name, 0) == 0; }))
      floors_.push_back(text);
  }
  if (segments_++ == 0) {
    const SimulationReport first = all_;
    all_ = r;
    all_.model = first.model, all_.looks_for_events = true;
    all_.events = first.events, all_.constraints_each.clear(), all_.monitors.clear();
    all_.conserved.clear();
    std::erase_if(all_.warnings, of_its_own);
    std::erase_if(all_.notes, is_of_support);
  } else {
    all_.steps += r.steps;
    all_.rows_looked_at += r.rows_looked_at;
    all_.order = std::max(all_.order, r.order);
    for (const auto member : {&SimulationReport::newton, &SimulationReport::projected, &SimulationReport::constraints,
                              &SimulationReport::constraints_kept, &SimulationReport::turned_over})
      all_.*member = std::max(all_.*member, r.*member);
    if (r.smallest_sigma < all_.smallest_sigma)
      all_.smallest_sigma = r.smallest_sigma, all_.smallest_sigma_t = r.smallest_sigma_t;
    for (const Warning& w : r.warnings)
      if (!of_its_own(w) && !named(w)) all_.warnings.push_back(w);
    all_.method.taylor_steps += r.method.taylor_steps;
    all_.method.steps += r.method.steps;
    all_.method.refused += r.method.refused;
    all_.method.evaluations += r.method.evaluations;
  }
  for (const ConstraintReport& c : r.constraints_each) {
    const auto known = std::find_if(all_.constraints_each.begin(), all_.constraints_each.end(),
                                    [&](const ConstraintReport& o) { return o.name == c.name; });
    if (known == all_.constraints_each.end()) {
      all_.constraints_each.push_back(c);
      continue;
    }
    for (std::size_t k = 0; k < std::min(known->residuals.size(), c.residuals.size()); ++k)
      known->residuals[k] = std::max(known->residuals[k], c.residuals[k]);
  }
  join(all_.monitors, r.monitors);
  join(all_.conserved, r.conserved);
  for (EventReport e : r.events) {
    const auto known = contacts.find(e.name);
    if (known == contacts.end() && e.stop) goes_on = false;
    if (known != contacts.end()) {
      if (!known->second.is_told()) continue;
      e.stop = false;
      while (!e.name.empty() && e.name.back() == '\'') e.name.pop_back();
      // A change has two events if its forces may be zero at the start, and the two may fall together.
      if (!all_.events.empty() && all_.events.back().name == e.name && all_.events.back().t.value == e.t.value)
        continue;
    }
    all_.events.push_back(std::move(e));
  }
  return goes_on;
}

void JoinedReport::by_bdf(double t, SimulationReport r) {
  r.method.asked = Method::automatic, r.method.last = Method::taylor;
  add(r, {});
  if (all_.method.turns.empty())
    all_.method.turns.push_back(
        {t, stiff_method(), "where slips are so slow that friction is stiff, and Taylor elsewhere"});
}

void JoinedReport::set(double t, const std::vector<EventReport::Change>& changes, const std::string& without_event) {
  const auto last = [&](const std::function<bool(const EventReport&)>& is) {
    return std::find_if(all_.events.rbegin(), all_.events.rend(),
                        [&](const EventReport& e) { return e.t.value == t && e.changes.empty() && is(e); });
  };
  auto hit = last([&](const EventReport& e) { return e.name == without_event; });
  if (hit == all_.events.rend()) hit = last([](const EventReport&) { return true; });
  if (hit != all_.events.rend())
    hit->changes = changes;
  else
    all_.events.push_back({without_event, {t, ""}, changes});
}

void JoinedReport::event(const std::string& name, double t) { all_.events.push_back({name, {t, ""}, {}}); }

bool JoinedReport::has(const std::string& name, double t) const {
  const auto last =
      std::find_if(all_.events.rbegin(), all_.events.rend(), [&](const EventReport& e) { return e.name == name; });
  return last != all_.events.rend() && last->t.value == t;
}

void JoinedReport::event_once(const std::string& name, double t) {
  if (!has(name, t)) event(name, t);
}

void JoinedReport::take_back(const std::string& name) {
  const auto last =
      std::find_if(all_.events.rbegin(), all_.events.rend(), [&](const EventReport& e) { return e.name == name; });
  if (last != all_.events.rend()) all_.events.erase(std::next(last).base());
}

void JoinedReport::rename(const std::string& name, const std::string& other) {
  const auto last =
      std::find_if(all_.events.rbegin(), all_.events.rend(), [&](const EventReport& e) { return e.name == name; });
  if (last != all_.events.rend()) last->name = other;
}

// The rank of an event of a contact among those of one instant; nullopt for an event of the model.
std::optional<int> JoinedReport::rank(const EventReport& e) const {
  const std::size_t dot = e.name.rfind('.');
  if (dot == std::string::npos ||
      std::find(contacts_.begin(), contacts_.end(), e.name.substr(0, dot)) == contacts_.end())
    return std::nullopt;
  const std::string what = e.name.substr(dot + 1);
  return what == "hits" ? 0 : what == "rests" ? 2 : 1;
}

// Sorts the events of contacts; events of the model keep their places.
void JoinedReport::order_events() {
  std::vector<EventReport>& all = all_.events;
  for (std::size_t from = 0, to = 0; from < all.size(); from = to) {
    std::vector<std::size_t> places;
    std::vector<EventReport> of_contacts;
    for (; to < all.size() && all[to].t.value == all[from].t.value; ++to)
      if (rank(all[to])) places.push_back(to), of_contacts.push_back(all[to]);
    std::stable_sort(of_contacts.begin(), of_contacts.end(),
                     [&](const EventReport& a, const EventReport& b) { return *rank(a) < *rank(b); });
    for (std::size_t k = 0; k < places.size(); ++k) all[places[k]] = of_contacts[k];
  }
}

SimulationReport JoinedReport::report(Outcome outcome, double t, std::size_t rows) {
  all_.outcome = std::move(outcome);
  for (const std::string& contact : contacts_) {
    const bool named = put_known_names(contact, all_.outcome.message);
    const std::string constraint = "write the constraint in";
    const std::size_t at = named ? all_.outcome.hint.find(constraint) : std::string::npos;
    if (at != std::string::npos) all_.outcome.hint.replace(at, constraint.size(), "write the contact in");
    for (Warning& w : all_.warnings) put_known_names(contact, w.message);
  }
  order_events();
  all_.t = t;
  all_.rows = rows;
  all_.notes.insert(all_.notes.end(), floors_.begin(), floors_.end());
  all_.power = power_miss_ / (all_.turned_over > 0 ? all_.turned_over : 1);
  for (const WatchedReport& w : all_.conserved)
    if (!(w.largest_change <= kConserved)) all_.warnings.push_back(not_conserved(w.name, w.largest_change));
  all_.no_error = "a motion with contacts has no estimate of its error";
  return all_;
}

}  // namespace anholon
