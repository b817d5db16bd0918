#include <algorithm>
#include <cstdio>

#include "base/json.h"
#include "cli/conserved.h"
#include "cli/input.h"
#include "cli/show.h"

namespace anholon::cli {

namespace {

// What the model contains beyond classical mechanics, in words.
std::vector<std::string> effects(const Model& model) {
  std::vector<std::string> list;
  if (model.observer.inertial) list.push_back("the observer is inertial");
  if (!is_zero(model.observer.spin)) list.push_back("the observer turns (Coriolis, centrifugal and Euler forces)");
  if (!is_zero(model.observer.origin_acceleration)) list.push_back("the observer's origin accelerates");
  for (const VaryingMass& m : model.masses)
  {
    SymbolNames names = model.names;
    names.defined.erase(m.value.id);
    list.push_back("the " + std::string(m.weight ? "second moment" : "mass") + " of '" + m.name + "' varies: " + print(m.value, names, Format::text));
  }
  for (const Body& b : model.bodies)
    if (b.expelled_velocity) list.push_back("'" + b.name + "' expels or collects matter");
  return list;
}

std::vector<std::string> external_forces(const Model& model) {
  std::vector<std::string> list;
  for (const Force& f : model.forces)
    if (!f.from && f.kind != Force::Kind::generalized)
      list.push_back("'" + f.name + "' on '" + model.bodies[f.on.body].name + "'");
  return list;
}

std::string describe(const ConstraintClass& c, int order) {
  if (order == 0) return std::string(c.rheonomic ? "holonomic, rheonomic" : "holonomic");
  std::string s = "order " + std::to_string(order) + ", ";
  s += c.kind == "nonlinear" ? "nonlinear" : c.kind == "linear" ? "linear homogeneous" : "affine";
  if (c.kind == "nonlinear") s += c.homogeneous ? ", homogeneous" : ", not homogeneous";
  if (c.rheonomic) s += ", rheonomic";
  return s;
}

std::string work(const ConstraintClass& c, int order) {
  if (order == 0) return c.rheonomic ? "may do work (rheonomic)" : "does no work";
  if (order == 1) return c.homogeneous ? "does no work" : "may do work";
  return "may do work";
}

// An entry of the state beyond positions and velocities.
struct Entry {
  std::string name;
  double value;
  Origin origin;
};

std::vector<Entry> higher_state(const Scenario& s) {
  std::vector<Entry> list;
  if (!s.routh) return list;
  const Graph& g = *s.model->graph;
  for (int k = 0; k < *std::max_element(s.routh_structure.d.begin(), s.routh_structure.d.end()); ++k)
    for (std::size_t j = 0; j < s.routh->size(); ++j) {
      if (k >= s.routh_structure.d[j] || (j < s.routh->coordinates && k < 2)) continue;
      const Node& n = g.node(s.routh->symbol(j, static_cast<unsigned>(k)).id);
      list.push_back({derivative_name(s.routh->variable_names[j], static_cast<unsigned>(k), Format::text), *s.state.value(n), *s.state.origin(n)});
    }
  // Coordinates first, by order.
  std::stable_partition(list.begin(), list.end(), [](const Entry& e) { return e.name.rfind("lambda.", 0) != 0; });
  return list;
}

// What initial data the structure asks for, where it is not positions and velocities alone.
std::string data_needed(const Scenario& s, const std::vector<Entry>& higher) {
  std::string list, choices;
  for (const Entry& e : higher) {
    list += ", " + e.name;
    if (e.origin == Origin::chosen) choices += (choices.empty() ? "" : ", ") + e.name;
  }
  if (list.empty()) return {};
  return "initial data: " + std::to_string(s.structure.state_dimension) + " numbers, among positions, velocities" + list + "; " +
         (choices.empty() ? "all of these are given or derived" : "nobody gave " + choices + ": a choice");
}

void state_table(const Scenario& s) {
  const InitialState<double>& x = s.state;
  const std::vector<Entry> higher = higher_state(s);
  if (const std::string needed = data_needed(s, higher); !needed.empty()) std::printf("%s\n", needed.c_str());
  std::printf("initial state at t = %s\n", number_text(x.t).c_str());
  for (std::size_t a = 0; a < x.q.size(); ++a)
    std::printf("  %-8s = %-22s %-10s %-9s = %-22s %s\n", s.model->coordinates[a].name.c_str(), number_text(x.q[a]).c_str(),
                name(x.q_origin[a]), (s.model->coordinates[a].name + "'").c_str(), number_text(x.qd[a]).c_str(), name(x.qd_origin[a]));
  for (const Entry& e : higher) std::printf("  %-8s = %-22s %s\n", e.name.c_str(), number_text(e.value).c_str(), name(e.origin));
  std::printf("  (given; derived from constraints and conditions; chosen: 0 by default; guess: as guessed; corrected: a rounded number made consistent)\n");
}

void text(const Scenario& s, const Outcome& outcome) {
  const Model& model = *s.model;
  std::printf("%s\n", model.title.empty() ? model.source_text.name.c_str() : model.title.c_str());
  if (!model.source.empty()) std::printf("source: %s\n", model.source.c_str());
  const auto count = [](std::size_t n, const char* one, const char* many) { return std::to_string(n) + " " + (n == 1 ? one : many); };
  std::printf("\n%s, %s, %s, %s\n", count(model.coordinates.size(), "coordinate", "coordinates").c_str(),
              count(model.bodies.size(), "body or particle", "bodies and particles").c_str(),
              count(model.constraints.size(), "constraint", "constraints").c_str(),
              count(model.parameters.size(), "parameter", "parameters").c_str());
  for (const std::string& e : effects(model)) std::printf("  %s\n", e.c_str());
  const std::vector<std::string> external = external_forces(model);
  for (const std::string& f : external) std::printf("  external force %s (it has no 'from')\n", f.c_str());
  if (!model.constraints.empty()) std::printf("\nconstraints\n");
  for (std::size_t r = 0; r < model.constraints.size(); ++r) {
    const Constraint& c = model.constraints[r];
    std::printf("  %-14s %s\n", c.name.c_str(), c.equation.c_str());
    std::printf("  %-14s %s; %s%s\n", "", describe(s.classes[r], c.order).c_str(), work(s.classes[r], c.order).c_str(),
                s.classes[r].redundant ? "; redundant here" : "");
  }
  if (!model.constraints.empty()) std::printf("  reactions: ideal in the sense of Chetaev and Niu (a postulate for orders of 2 and more)\n");
  if (outcome.ok()) {
    std::printf("\ndegrees of freedom %d, configuration dimension %d, state dimension %d\n", s.structure.degrees_of_freedom,
                s.structure.configuration_dimension, s.structure.state_dimension);
    std::printf("%s\n", print(s.system, s.structure).c_str());
    state_table(s);
    print_conserved(*s.mechanics);
  }
  for (const std::string& n : s.notes) std::printf("note: %s\n", n.c_str());
}

void json(const Scenario& s, const Outcome& outcome) {
  const Model& model = *s.model;
  JsonWriter j;
  j.open_object();
  j.key("title").string(model.title);
  j.key("source").string(model.source);
  j.key("coordinates").open_array();
  for (const Coordinate& c : model.coordinates) j.string(c.name);
  j.close();
  j.key("constraints").open_array();
  for (std::size_t r = 0; r < model.constraints.size(); ++r) {
    const Constraint& c = model.constraints[r];
    j.open_object();
    j.key("name").string(c.name).key("order").integer(c.order).key("kind").string(s.classes[r].kind);
    j.key("homogeneous").boolean(s.classes[r].homogeneous).key("rheonomic").boolean(s.classes[r].rheonomic);
    j.key("redundant").boolean(s.classes[r].redundant).key("equation").string(c.equation);
    j.close();
  }
  j.close();
  const auto strings = [&](const char* key, const std::vector<std::string>& list) {
    j.key(key).open_array();
    for (const std::string& x : list) j.string(x);
    j.close();
  };
  strings("effects", effects(model));
  strings("external_forces", external_forces(model));
  j.key("reactions_hypothesis").string(model.constraints.empty() ? "none" : "ideal (Chetaev-Niu)");
  if (outcome.ok()) {
    j.key("degrees_of_freedom").integer(s.structure.degrees_of_freedom);
    j.key("configuration_dimension").integer(s.structure.configuration_dimension);
    j.key("state_dimension").integer(s.structure.state_dimension);
    j.key("offsets").open_object().key("c").open_object();
    for (std::size_t i = 0; i < s.system.size(); ++i) j.key(s.system.equation_names[i]).integer(s.structure.c[i]);
    j.close().key("d").open_object();
    for (std::size_t i = 0; i < s.system.size(); ++i) j.key(s.system.variable_names[i]).integer(s.structure.d[i]);
    j.close().close();
    j.key("signature").open_array();
    for (const auto& row : s.structure.sigma) {
      j.open_array();
      for (int e : row) e == kAbsent ? j.null() : j.integer(e);
      j.close();
    }
    j.close();
    j.key("initial").open_object().key("t").number(number_text(s.state.t));
    for (std::size_t a = 0; a < s.state.q.size(); ++a)
      for (int k = 0; k < 2; ++k) {
        j.key(model.coordinates[a].name + (k ? "'" : "")).open_object();
        j.key("value").number(number_text(k ? s.state.qd[a] : s.state.q[a]));
        j.key("origin").string(name(k ? s.state.qd_origin[a] : s.state.q_origin[a])).close();
      }
    for (const Entry& e : higher_state(s)) j.key(e.name).open_object().key("value").number(number_text(e.value)).key("origin").string(name(e.origin)).close();
    j.close();
  }
  if (outcome.ok()) write_conserved(j, *s.mechanics);
  strings("notes", s.notes);
  j.key("outcome").string(name(outcome.kind));
  if (!outcome.ok()) j.key("message").string(outcome.message).key("hint").string(outcome.hint);
  j.close();
  std::printf("%s\n", j.text().c_str());
}

}  // namespace

int check(const Options& o) {
  const Reader in = read(o);
  Scenario s;
  Outcome outcome = ready(in, form(o, *in.model), state_choice(o, *in.model), s);
  if (outcome.ok() && !not_integrated(*in.model)) outcome = regular_at_start(s);
  if (!o.show.empty()) return show(o, s);
  if (o.json) json(s, outcome);
  else text(s, outcome);
  if (outcome.ok()) return kOk;
  print_outcome(outcome);
  return kStopped;
}

}  // namespace anholon::cli
