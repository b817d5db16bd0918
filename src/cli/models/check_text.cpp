#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include "cli/models/check_report.h"
#include "cli/models/conserved.h"
#include "cli/say.h"
#include "motion/start.h"
#include "observe/rows/row_values.h"

namespace anholon::cli {

namespace {

constexpr std::size_t kLongestPower = 120;  // characters; a longer formula is only in --json

std::string counted(std::size_t n, const char* one, const char* many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

// Prints the hypotheses on the reactions, each with its constraints if not all constraints have it.
void reactions(const Scenario& s, const Explanation& x) {
  const auto with = [&](Hypothesis h) {
    std::vector<std::size_t> list;
    for (std::size_t r = 0; r < x.constraints.size(); ++r)
      if (x.constraints[r].hypothesis == h && !s.model->constraints[r].by) list.push_back(r);
    return list;
  };
  const auto line = [&](Hypothesis h) {
    const std::vector<std::size_t> list = with(h);
    if (list.empty()) return;
    const std::string whose = list.size() < x.constraints.size() ? " of " + listed(*s.model, list) : "";
    say(stdout, "  reactions%s: %s\n", whose.c_str(), in_words(h));
  };
  for (std::size_t r = 0; r < x.constraints.size(); ++r)
    if (const auto by = s.model->constraints[r].by)
      say(stdout, "  %s is kept by the input %s (servo): no ideal reaction\n", s.model->constraints[r].name.c_str(),
          s.model->controls[*by].name.c_str());
  line(Hypothesis::dalembert);
  line(Hypothesis::chetaev);
  line(Hypothesis::niu);
}

// Prints names by their units, if the file has any.
void units(const Model& model) {
  std::vector<std::pair<std::string, std::string>> lists;  // in the order of first occurrence of the units
  const auto add = [&](const std::vector<std::string>& names, const std::vector<std::string>& of) {
    for (std::size_t k = 0; k < of.size(); ++k) {
      const std::string unit = of[k].empty() ? "not told" : of[k];
      auto it = std::find_if(lists.begin(), lists.end(), [&](const auto& l) { return l.first == unit; });
      if (it == lists.end()) it = lists.insert(lists.end(), {unit, ""});
      it->second += (it->second.empty() ? "" : ", ") + names[k];
    }
  };
  add(model.names.coordinates, model.coordinate_units);
  add(model.names.parameters, model.parameter_units);
  if (!lists.empty()) say(stdout, "\nunits\n");
  for (const auto& [unit, names] : lists) say(stdout, "  %-14s %s\n", unit.c_str(), names.c_str());
}

void integrability(const Scenario& s, const Explanation& x) {
  const Model& model = *s.model;
  const Integrability& i = x.integrability;
  std::string flag;
  for (int d : i.flag) flag += (flag.empty() ? "" : ", ") + std::to_string(d);
  if (!i.undecided.empty()) {
    const std::string most = i.flag.empty() ? ""
                                            : "; no more than " + std::to_string(i.integrable()) + " of " +
                                                  std::to_string(i.constraints.size()) +
                                                  " are integrable (derived flag " + flag + ", …)";
    say(stdout, "  integrability: not decided: %s%s\n", i.undecided.c_str(), most.c_str());
    return;
  }
  if (i.constraints.empty()) return;
  const std::size_t count = i.constraints.size(), p = static_cast<std::size_t>(i.integrable());
  std::string text = count == 1 ? listed(model, i.constraints) + (p ? " is integrable" : " is not integrable")
                     : p == 0   ? "none of the " + std::to_string(count) +
                                    " linear constraints on velocities is integrable, alone or with others"
                     : p == count ? "all " + std::to_string(count) + " linear constraints on velocities are integrable"
                                  : "of the " + std::to_string(count) + " linear constraints on velocities " +
                                        counted(p, "combination is", "combinations are") + " integrable";
  if (p > 0 && !i.proved) text += ", as it seems by numbers; it was not proved";
  if (i.these_values) text += ", for these values of the parameters";
  say(stdout, "  integrability: %s (derived flag %s%s)\n", text.c_str(), flag.c_str(),
      i.time ? ", t as a coordinate" : "");
  for (const IntegrableCombination& c : i.combinations) {
    std::vector<std::size_t> members;
    for (std::size_t r = 0; r < c.coefficients.size(); ++r)
      if (!is_zero(c.coefficients[r])) members.push_back(r);
    const std::string whose = listed(model, members);
    if (!c.integral)
      say(stdout, "    %s: in the integrable part; no elementary integral was found\n", whose.c_str());
    else
      say(stdout, "    %s %s: %s = const\n", whose.c_str(), members.size() > 1 ? "together" : "alone",
          print(*c.integral, model.names, Format::text).c_str());
  }
  if (!x.accessible) return;
  const int all = s.structure.configuration_dimension;
  say(stdout,
      "    motions from one configuration reach a set of dimension %d in the configuration space of dimension %d\n",
      *x.accessible, all);
}

std::string derivative_of(int order) {
  return order == kAbsent ? "multipliers"
         : order == 0     ? "positions"
         : order == 1     ? "velocities"
         : order == 2     ? "accelerations"
                          : "derivatives of order " + std::to_string(order);
}

// Equations of motion have the names of coordinates.
std::string hidden_name(const Scenario& s, const HiddenConstraint& h) {
  return (h.equation < s.system.coordinates ? "motion." : "") + s.system.equation_names[h.equation];
}

void structure(const Scenario& s, const Explanation& x) {
  say_lines(stdout, print(s.system, s.structure) + "\n");
  if (x.blocks.size() > 1) say_lines(stdout, print(s.system, s.structure, x.blocks) + "\n");
  if (x.hidden.empty()) return;
  say(stdout, "what the state must satisfy (hidden constraints)\n");
  // Groups them by the derivatives that they restrict.
  std::map<int, std::string> on;
  for (const HiddenConstraint& h : x.hidden)
    for (std::size_t k = 0; k < h.orders.size(); ++k) {
      std::string& list = on[h.orders[k]];
      list += (list.empty() ? "" : ", ") + derivative_name(hidden_name(s, h), static_cast<unsigned>(k), Format::text);
    }
  for (const auto& [order, list] : on) say(stdout, "  on %s: %s\n", derivative_of(order).c_str(), list.c_str());
  say(stdout, "\n");
}

// Describes the initial data that the structure needs, and the origin of each value.
std::string data_needed(const Scenario& s, const InitialState<double>& x, const std::vector<StateEntry>& higher) {
  constexpr std::size_t kNamed = 8;  // of more choices only the number is printed: the table shows them
  std::vector<std::string> chosen;
  std::size_t given = 0, derived = 0;
  const auto count = [&](const std::string& name, Origin origin) {
    switch (origin) {
    case Origin::given:
    case Origin::corrected:
      ++given;
      break;
    case Origin::derived:
      ++derived;
      break;
    case Origin::chosen:
    case Origin::guessed:
      chosen.push_back(name);
      break;
    }
  };
  for (std::size_t a = 0; a < x.q.size(); ++a) count(s.model->coordinates[a].name, x.q_origin[a]);
  for (std::size_t a = 0; a < x.q.size(); ++a) count(s.model->coordinates[a].name + "'", x.qd_origin[a]);
  std::string among;
  for (const StateEntry& e : higher) count(e.name, e.origin), among += ", " + e.name;
  std::string out =
      "initial data: " + counted(static_cast<std::size_t>(s.structure.state_dimension), "number", "numbers") +
      " may be prescribed, among " + (among.empty() ? "positions and velocities" : "positions, velocities" + among) +
      "; " + std::to_string(given) + " given, " + std::to_string(derived) + " derived, " +
      std::to_string(chosen.size()) + " chosen";
  if (chosen.empty() || chosen.size() > kNamed) return out;
  std::string names;
  for (const std::string& name : chosen) names += (names.empty() ? "" : ", ") + name;
  return out + " (" + names + ")";
}

// A computed value that is round-off of others is printed as 0.
std::string value_text(double value, Origin origin, const InitialState<double>& x) {
  constexpr double kRoundOff = 1e-30;
  double largest = 0;
  for (const std::vector<double>* level : {&x.q, &x.qd})
    for (double v : *level) largest = std::max(largest, std::abs(v));
  const bool found = origin != Origin::given && origin != Origin::guessed;
  return number_text(found && std::abs(value) < kRoundOff * largest ? 0.0 : value);
}

void state_table(const Scenario& s) {
  const InitialState<double> x = start_as_in_rows(s);
  const std::vector<StateEntry> higher = higher_state(s);
  if (!x.q.empty()) say(stdout, "%s\n", data_needed(s, x, higher).c_str());
  const std::map<std::string, std::string> units = column_units(*s.model);
  const auto behind = [&](const std::string& name) {
    const auto unit = units.find(name);
    return unit == units.end() || unit->second == "1" ? "" : " " + unit->second;
  };
  say(stdout, "initial state at t = %s%s\n", number_text(x.t).c_str(), behind("t").c_str());
  constexpr std::size_t kWidest = 22;  // without units
  std::vector<std::array<std::string, 2>> texts;
  std::size_t width = kWidest;
  for (std::size_t a = 0; a < x.q.size(); ++a) {
    const std::string& q = s.model->coordinates[a].name;
    texts.push_back(
        {value_text(x.q[a], x.q_origin[a], x) + behind(q), value_text(x.qd[a], x.qd_origin[a], x) + behind(q + "'")});
    for (const std::string& text : texts.back()) width = std::max(width, text.size());
  }
  for (std::size_t a = 0; a < x.q.size(); ++a) {
    const std::string& q = s.model->coordinates[a].name;
    say(stdout, "  %-8s = %-*s %-10s %-9s = %-*s %s\n", q.c_str(), static_cast<int>(width), texts[a][0].c_str(),
        name(x.q_origin[a]), (q + "'").c_str(), static_cast<int>(width), texts[a][1].c_str(), name(x.qd_origin[a]));
  }
  for (const StateEntry& e : higher)
    say(stdout, "  %-8s = %-22s %s\n", e.name.c_str(), (number_text(e.value) + behind(e.name)).c_str(), name(e.origin));
  say(stdout,
      "  (given; derived from constraints and conditions; chosen: 0, or the least change if constraints leave a "
      "choice; guess: as guessed; corrected: a rounded number made consistent)\n");
}

}  // namespace

void check_text(Workspace& s, const Explanation& x, const Outcome& outcome) {
  const Model& model = *s.model;
  say(stdout, "%s\n", model.title.empty() ? model.source_text.name.c_str() : model.title.c_str());
  if (!model.source.empty()) say(stdout, "source: %s\n", model.source.c_str());
  std::string cases;
  for (const std::string& c : model.cases) cases += (cases.empty() ? "" : ", ") + c;
  if (!cases.empty()) say(stdout, "cases (--case NAME): %s\n", cases.c_str());
  say(stdout, "\n%s, %s, %s, %s\n", counted(model.coordinates.size(), "coordinate", "coordinates").c_str(),
      counted(model.bodies.size(), "body or particle", "bodies and particles").c_str(),
      counted(model.constraints.size(), "constraint", "constraints").c_str(),
      counted(model.parameters.size(), "parameter", "parameters").c_str());
  for (const std::string& e : effects(model)) say(stdout, "  %s\n", e.c_str());
  const std::vector<std::string> external = external_forces(model);
  for (const std::string& f : external) say(stdout, "  external force %s (it has no 'from')\n", f.c_str());
  units(model);
  if (!model.constraints.empty()) say(stdout, "\nconstraints\n");
  for (std::size_t r = 0; r < model.constraints.size(); ++r) {
    const Constraint& c = model.constraints[r];
    say(stdout, "  %-14s %s\n", c.name.c_str(), c.equation.c_str());
    std::string redundant;
    if (s.classes[r].vanishes)
      redundant = "; vanishes identically with these values of the parameters";
    else if (s.classes[r].redundant)
      redundant = x.constraints[r].follows_from.empty()
                      ? "; redundant here"
                      : (outcome.ok() ? "; redundant here: it follows from " : "; its row depends here on that of ") +
                            listed(model, x.constraints[r].follows_from);
    // A vector equation has one component too many.
    if (!redundant.empty() && !s.classes[r].vanishes && c.name.find('.') != std::string::npos && c.name.back() >= 'x')
      redundant += "; 'along' names the directions that count";
    say(stdout, "  %-14s %s; %s%s\n", "", description(s.classes[r], c.order).c_str(),
        work(s, x.constraints[r], r, kLongestPower).c_str(), redundant.c_str());
  }
  reactions(s, x);
  integrability(s, x);
  if (outcome.ok()) {
    say(stdout, "\ndegrees of freedom %d, configuration dimension %d, state dimension %d\n",
        s.structure.degrees_of_freedom, s.structure.configuration_dimension, s.structure.state_dimension);
    structure(s, x);
    state_table(s);
    print_conserved(*s.mechanics);
  }
  for (const std::string& n : s.notes) say(stdout, "note: %s\n", n.c_str());
}

}  // namespace anholon::cli
