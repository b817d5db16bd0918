#include "cli/motions/motion_report.h"

#include <algorithm>
#include <cstdio>

#include "cli/say.h"
#include "simulation/report_text.h"

namespace anholon::cli {

namespace {

// Prints the methods of integration; prints nothing if Taylor's made every step and no other was tried.
void method(const MethodReport& r) {
  if (!r.differs_from_taylor()) return;
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  if (r.asked == Method::automatic) {
    if (r.turns.empty()) add("Taylor, others were tried and not cheaper");
    for (const MethodReport::Turn& turn : r.turns)
      add(std::string(info(turn.to).title) + " from t = " + number_text(turn.t, 6) + " on, " + turn.why);
  } else {
    add(std::string(info(r.asked).title) + ", as asked");
    for (const MethodReport::Turn& turn : r.turns)
      add(std::string(info(turn.to).title) + " from t = " + number_text(turn.t, 6) + " on, " + turn.why);
  }
  if (r.steps > 0) {
    add(std::to_string(r.steps) + " steps (" + std::to_string(r.refused) + " refused), " +
        std::to_string(r.evaluations) + " evaluations");
    if (r.taylor_steps > 0) add(std::to_string(r.taylor_steps) + " steps by Taylor");
  }
  if (r.trials > 0)
    add(std::to_string(r.trials) + (r.trials == 1 ? " trial, " : " trials, ") + std::to_string(r.trial_evaluations) +
        " evaluations");
  say(stderr, "method: %s\n", text.c_str());
}

// Returns ", worst 'blade''" for the first derivative of the constraint `blade` with the largest residual; empty if all
// residuals are zero.
std::string worst_constraint(const SimulationReport& r) {
  std::string name;
  double worst = 0;
  for (const ConstraintReport& c : r.constraints_each)
    for (std::size_t k = 0; k < c.residuals.size(); ++k)
      if (c.residuals[k] > worst)
        worst = c.residuals[k], name = derivative_name(c.name, static_cast<unsigned>(k), Format::text);
  return name.empty() ? "" : ", worst '" + name + "'";
}

// Names the motion with which a second opinion is compared.
std::string beside(const SimulationReport& r) {
  return r.method.steps > 0 ? "the motion by method " + std::string(name(r.method.last)) : "Taylor's motion";
}

void second_opinion(const Scenario& s, const SimulationReport& r) {
  const SecondOpinion& o = *r.second;
  say(stderr,
      "second opinion: the rows are those of %s%s (%zu steps, %zu evaluations, %.3g s); they differ from %s by at most "
      "%s (%s at t = %s, relative to 1 + |%s|)\n",
      name(o.integrator), o.form == s.system.form->name ? "" : " on Routh's equations", o.steps, o.evaluations,
      o.seconds, beside(r).c_str(), small(o.difference).c_str(), o.of.c_str(), number_text(o.t, 6).c_str(),
      o.of.c_str());
}

using Units = std::map<std::string, std::string>;

// Returns " m" to follow a number in m; empty for a pure number and for an unknown unit.
std::string behind(const Units& units, const std::string& name) {
  const auto it = units.find(name);
  return it == units.end() || it->second.empty() || it->second == "1" ? "" : " " + it->second;
}

// Prints lines such as "event burn_out at t = 160: stage 1 -> 2, fuel 0 -> 90000".
void events(const SimulationReport& r, const Units& units) {
  constexpr std::size_t kMostLines = 20;
  for (std::size_t k = 0; k < r.events.size() && k < kMostLines; ++k) {
    const EventReport& e = r.events[k];
    std::string list;
    for (const auto& c : e.changes)
      list += (list.empty() ? ": " : ", ") + c.name + " " + c.before.text() + " -> " + c.after.text() +
              behind(units, c.name);
    if (e.correction > 0) list += "; made consistent by " + small(e.correction);
    say(stderr, "event %s at t = %s%s%s%s\n", e.name.c_str(), e.t.text().c_str(), behind(units, "t").c_str(),
        list.c_str(), e.stop ? ": the motion ends here" : "");
  }
  if (r.events.size() > kMostLines)
    say(stderr, "… and %zu more events (all of them with --json)\n", r.events.size() - kMostLines);
}

// Notes the constraints that are left out, in the words of `check`.
void redundant(const Scenario& s) {
  constexpr std::size_t kNamed = 8;
  for (const bool vanish : {true, false}) {
    std::string list;
    std::size_t count = 0;
    for (std::size_t r : s.redundant) {
      if (s.classes[r].vanishes != vanish || ++count > kNamed) continue;
      list += (count > 1 ? ", " : "") + s.model->constraints[r].name;
    }
    const bool one = count == 1;
    if (count > kNamed) list += ", …";
    const std::string which = (one ? " " : "s ") + list;
    if (count > 0 && vanish)
      say(stderr, "note: constraint%s %s identically with these values of the parameters: %s left out\n", which.c_str(),
          one ? "vanishes" : "vanish", one ? "it is" : "they are");
    else if (count > 0)
      say(stderr, "note: constraint%s %s on the others at the initial state: %s left out, and watched\n", which.c_str(),
          one ? "depends" : "depend", one ? "it is" : "they are");
  }
}

}  // namespace

void print_report(const Scenario& s, const SimulationReport& r, const Units& units, bool goes_on) {
  std::fflush(stdout);
  // `check` prints the notes that concern the model itself; here only those of the state follow.
  for (const std::string& n : s.state.notes) say(stderr, "note: %s\n", n.c_str());
  redundant(s);
  const std::string before = r.second ? "not projected" : "before projection " + small(r.constraints);
  std::string looked_at = r.rows_looked_at < r.rows
                              ? ", at " + std::to_string(r.rows_looked_at) + " of " + std::to_string(r.rows) + " rows"
                              : "";
  if (goes_on)
    looked_at += looked_at.empty() ? ", with the part before" : " of this part, and at those of the part before";
  say(stderr,
      "residual report (relative%s): Newton's law %s, without multipliers %s, constraints %s (%s%s), power balance "
      "%s\n",
      looked_at.c_str(), small(r.newton).c_str(), small(r.projected).c_str(), small(r.constraints_kept).c_str(),
      before.c_str(), worst_constraint(r).c_str(), small(r.power).c_str());
  if (r.error)
    say(stderr, "digits to trust%s\n", digits_to_trust(*r.error).c_str());
  else if (!r.no_error.empty())
    say(stderr, "digits to trust: not estimated, %s\n", r.no_error.c_str());
  events(r, units);
  for (const WatchedReport& w : r.conserved)
    say(stderr, "conserved: %s = %s, largest change %s of its terms\n", w.name.c_str(),
        (w.first.text() + behind(units, w.name) + behind(units, "conserved " + w.name)).c_str(),
        small(w.largest_change).c_str());
  for (const WatchedReport& w : r.monitors) {
    const std::string unit = behind(units, w.name);
    // Columns of contacts and of switched constraints jump, and gaps begin at zero: size is no measure of a change.
    const bool of_model = std::any_of(s.model->monitors.begin(), s.model->monitors.end(),
                                      [&](const Monitor& m) { return m.name == w.name; });
    const std::string times = w.times > 0 ? " at " + std::to_string(w.times) + (w.times == 1 ? " time" : " times") : "";
    say(stderr, "monitor %s: from %s to %s%s, between %s and %s%s%s%s\n", w.name.c_str(), w.first.text().c_str(),
        w.last.text().c_str(), unit.c_str(), w.least.text().c_str(), w.greatest.text().c_str(), unit.c_str(),
        times.c_str(), of_model ? (", largest change " + small(w.largest_change) + " of its size").c_str() : "");
  }
  if (r.rigorous) {
    const RigorousReport& g = *r.rigorous;
    say(stderr,
        "rigorous, %s of the dense output: Newton's law misses by at most %s of its terms, without multipliers %s, "
        "constraints %s, steps join within %s\n",
        (g.times ? "at " + std::to_string(*g.times) + " times" : std::string("for all t")).c_str(), g.newton.c_str(),
        g.projected.c_str(), g.constraints.c_str(), g.joints.c_str());
    if (g.kink)
      say(stderr,
          "the bounds are large beside t = %s, where %s has a kink or jumps: --rigorous 64 bounds the residuals at "
          "times beside it, and a formula without jumps has bounds for all t\n",
          number_text(g.kink->t, 6).c_str(), g.kink->formula.c_str());
  }
  say(stderr, "%s%zu steps of order %d, %zu rows, smallest scaled singular value %s at t = %s, %.3g s\n",
      (r.second ? beside(r) + ": " : "").c_str(), r.steps, r.order, r.rows, small(r.smallest_sigma).c_str(),
      number_text(r.smallest_sigma_t, 6).c_str(), r.second ? r.seconds - r.second->seconds : r.seconds);
  method(r.method);
  if (r.second) second_opinion(s, r);
  for (const Warning& w : r.warnings) say(stderr, "warning: %s\nhint: %s\n", w.message.c_str(), w.hint.c_str());
}

}  // namespace anholon::cli
