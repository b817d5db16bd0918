#include "observe/evaluate.h"

#include <cstdio>

#include "base/json.h"
#include "cli/contacts.h"
#include "cli/input.h"
#include "cli/models/show.h"
#include "cli/say.h"

namespace anholon::cli {

namespace {

void named(JsonWriter& j, const char* key, const StateReport::Named& list) {
  j.key(key).open_object();
  for (const auto& [name, value] : list) j.key(name).number(value);
  j.close();
}

void vector(JsonWriter& j, const std::vector<std::string>& values) {
  j.open_array();
  for (const std::string& v : values) j.number(v);
  j.close();
}

std::string json(const Scenario& s, const StateReport& r) {
  JsonWriter j;
  j.open_object();
  j.key("model").string(s.model->title);
  j.key("form").string(s.system.form->name);
  j.key("t").number(r.t);
  j.key("state").open_object();
  for (const auto& [name, value] : r.q) j.key(name).number(value);
  for (const auto& [name, value] : r.qdot) j.key(name + "'").number(value);
  j.close();
  for (const auto& [name, column] : r.forces) {
    j.key(name).open_object();
    for (std::size_t a = 0; a < column.size(); ++a) j.key(s.model->coordinates[a].name).number(column[a]);
    j.close();
  }
  named(j, "derivatives", r.derivatives);
  // in "lambda" each constraint has its own name
  std::vector<std::pair<std::string, std::string>> multipliers = r.lambda;
  for (auto& [name, value] : multipliers)
    if (name.rfind("lambda.", 0) == 0) name = name.substr(7);
  named(j, "lambda", multipliers);
  for (const auto& [name, value] : r.numbers) j.key(name).number(value);
  j.key("mass_matrix").open_array();
  for (const auto& row : r.mass_matrix) vector(j, row);
  j.close();
  j.key("reactions").open_object();
  for (const StateReport::Reaction& x : r.reactions) {
    j.key(x.body).open_object();
    j.key("force");
    vector(j, x.force);
    j.key("torque");
    vector(j, x.torque);
    j.close();
  }
  j.close();
  named(j, "residuals", r.residuals);
  j.key("outcome").string("finished");
  j.close();
  return j.text() + "\n";
}

void print_text(const Scenario& s, const StateReport& r, int digits) {
  const int width = std::max(12, std::min(digits, 16) + 8);
  const auto line = [&](const std::string& name, const std::string& value) {
    say(stdout, "  %-18s %*s\n", name.c_str(), width, value.c_str());
  };
  if (!s.model->title.empty()) say(stdout, "%s\n", s.model->title.c_str());
  say(stdout, "%s, %s\n\nstate at t = %s\n", s.system.form->title, s.system.form->equation, r.t.c_str());
  for (const auto& [name, value] : r.q) line(name, value);
  for (const auto& [name, value] : r.qdot) line(name + "'", value);
  say(stdout, "\naccelerations\n");
  for (const auto& [name, value] : r.derivatives) line(name, value);
  if (!r.lambda.empty()) say(stdout, "\nmultipliers\n");
  for (const auto& [name, value] : r.lambda) line(name, value);
  say(stdout, "\ngeneralized forces\n  %-14s", "");
  for (const Coordinate& c : s.model->coordinates) say(stdout, " %*s", width, c.name.c_str());
  say(stdout, "\n");
  for (const auto& [name, column] : r.forces) {
    say(stdout, "  %-14s", name.c_str());
    for (const std::string& v : column) say(stdout, " %*s", width, v.c_str());
    say(stdout, "\n");
  }
  say(stdout, "\nenergy and power\n");
  for (const auto& [name, value] : r.numbers) line(name, value);
  say(stdout, "\nreactions (force; torque about the mass centre)\n");
  for (const StateReport::Reaction& x : r.reactions) {
    say(stdout, "  %-14s", x.body.c_str());
    for (const std::string& v : x.force) say(stdout, " %*s", width, v.c_str());
    say(stdout, "  ;");
    for (const std::string& v : x.torque) say(stdout, " %*s", width, v.c_str());
    say(stdout, "\n");
  }
  say(stdout, "\nresiduals (relative)\n");
  for (const auto& [name, value] : r.residuals) line(name, value);
}

}  // namespace

int evaluate(const SystemCommand& o) {
  if (o.motion.numbers == "double")
    throw UsageError{"error: a state is evaluated in long double at least\nhint: --numbers long-double or quad\n"};
  const Reader in = read(o);
  without_contacts(in, "evaluate");
  const StateChoice choice = state_choice(o, *in.model);
  Scenario s;
  Outcome outcome = ready(in, form(o, *in.model), choice, s);
  form(o, *in.model, Workspace(s).mechanics.get());
  if (const auto d = not_integrated(*in.model)) {
    print_diagnostic(*d, in.source);
    return kBadInput;
  }
  if (!o.show.empty()) return show(o, s, outcome);
  StateReport report;
  if (outcome.ok())
    outcome = evaluate(s, choice, precision(o.motion, Precision::long_real, asker()), o.digits(), report);
  if (!outcome.ok()) {
    if (o.json) {
      JsonWriter j;
      j.open_object().key("outcome").string(name(outcome.kind)).key("message").string(outcome.message);
      j.key("hint").string(outcome.hint).close();
      hand_out(j.text() + "\n");
    }
    print_outcome(outcome);
    return kStopped;
  }
  if (o.json)
    hand_out(json(s, report));
  else
    print_text(s, report, o.digits());
  for (const std::string& text : o.quiet ? std::vector<std::string>() : notes_of_redundancy(s))
    say(stderr, "note: %s\n", text.c_str());
  return kOk;
}

}  // namespace anholon::cli
