// Motions of models with contacts, for tests that examine their numbers.
#pragma once
#include "contact/hybrid.h"
#include "modelfile/read.h"
#include "setup/scenario.h"
#include "support/motion.h"

namespace anholon::test {

// The motion up to the time `to`, with rows at the times `at`, or at the steps if there are none. Throws if the model
// is refused.
inline Motion contact_motion(const std::string& text, const Rational& to, const Overrides& overrides = {},
                             const std::vector<Rational>& at = {},
                             const Rational& tolerance = SimulationOptions().tolerance,
                             const std::function<void(double, std::size_t)>& progress = {}) {
  const SourceText source{"test.toml", text};
  Diagnostics diagnostics;
  const auto open = open_model(source, diagnostics, overrides);
  if (!open) throw std::runtime_error("the model of this test is refused:\n" + diagnostics.print(source));
  Scenario s;
  const Outcome made = make_scenario(open->model, *find_formulation("routh"), {}, s);
  if (!made.ok()) throw std::runtime_error(made.message);
  Workspace own(s);
  SimulationOptions o;
  o.to = to;
  o.at = at;
  o.tolerance = tolerance;
  o.progress = progress;
  Motion m;
  m.report = simulate_with_contacts(own, contacts(*open->names), o, m.rows);
  return m;
}

// The times of the events of this name.
inline std::vector<double> times(const Motion& m, const std::string& event) {
  std::vector<double> list;
  for (const EventReport& e : m.report.events)
    if (e.name == event) list.push_back(e.t.value);
  return list;
}

}  // namespace anholon::test
