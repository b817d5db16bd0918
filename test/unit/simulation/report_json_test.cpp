// A report that is written and read back is the same report.
#include <gtest/gtest.h>

#include "simulation/report_json.h"

namespace anholon::report_json_test {
namespace {

SimulationReport full_report() {
  SimulationReport r;
  r.model = "a \"model\"", r.form = "routh";
  r.outcome = {OutcomeKind::singular, "the configuration is singular at t = 7.3", "start elsewhere"};
  r.t = 7.3000000000000007, r.steps = 120, r.order = 18, r.eliminations = 2;
  r.newton = 1.2345678901234567e-15, r.projected = 2e-16, r.constraints = 3e-14, r.constraints_kept = 4e-17;
  r.power = 5e-13, r.smallest_sigma = 0.012345678901234567, r.smallest_sigma_t = 7.2;
  r.constraints_each = {{"rod", {1e-17, 2e-16}}, {"blade", {3e-17}}};
  ErrorReport e;
  e.kinds = {{ColumnKind::coordinate, 1.1e-14, 13, "x", 7.1}, {ColumnKind::event_time, 2.2e-12, 11, "hit", 3}};
  e.means = "a second run", e.until = 6.5, e.stopped = "the step collapsed", e.lost = 6, e.lost_of = "x'";
  r.error = e;
  r.warnings = {{"near a singular configuration", "trust it less"}};
  r.notes = {"a floor pulls"};
  r.looks_for_events = true;
  r.events = {{"zeta",
               {0.5, ""},
               {{"n", {1, ""}, {2, ""}}, {"b", {0.1, "0.1000000000000000000000000001"}, {3, ""}}},
               1e-17,
               false},
              {"end", {7, ""}, {}, 0, true}};
  r.monitors = {{"E", {1, ""}, {2, ""}, {0.5, "0.50000000000000000000000000001"}, {3, ""}, 0.25}};
  r.conserved = {{"p", {1, ""}, {1, ""}, {1, ""}, {1, ""}, 1e-15}};
  r.method.asked = Method::automatic, r.method.last = Method::bdf, r.method.steps = 7, r.method.trials = 1;
  r.method.turns = {{0.25, Method::bdf, "it is stiff"}};
  r.second = SecondOpinion{Method::ida, "routh", 1e-9, "x", 3.5, 0, 40, 90, 0};
  r.rigorous = RigorousReport{64, 64, "1e-13", "2e-13", "3e-13", "inf", 64};
  return r;
}

TEST(ReportJson, ComesBackAsItWasWritten) {
  const std::string text = report_json(full_report());
  const std::optional<SimulationReport> r = read_report(text);
  ASSERT_TRUE(r.has_value());
  EXPECT_EQ(report_json(*r), text);
  EXPECT_EQ(r->newton, 1.2345678901234567e-15) << "all digits";
  ASSERT_EQ(r->events.size(), 2U);
  EXPECT_EQ(r->events.at(0).changes.at(0).name, "n") << "in the order of the file, not of the alphabet";
  EXPECT_EQ(r->events.at(0).changes.at(1).before.text(), "0.1000000000000000000000000001") << "digits beyond a double";
  EXPECT_EQ(r->events.at(0).changes.at(1).before.value, 0.1);
  EXPECT_EQ(r->outcome.kind, OutcomeKind::singular);
  EXPECT_EQ(r->method.turns.at(0).to, Method::bdf);
  EXPECT_EQ(r->error->kinds.at(1).kind, ColumnKind::event_time);
}

// Every number of the report changes its text, so the writer and the reader cannot both leave one out.
TEST(ReportJson, HoldsEveryNumber) {
  const std::string text = report_json(full_report());
  const auto changed = [&](auto change) {
    SimulationReport r = full_report();
    change(r);
    return report_json(r) != text;
  };
  EXPECT_TRUE(changed([](SimulationReport& r) { r.newton *= 1 + 1e-15; }));
  EXPECT_TRUE(changed([](SimulationReport& r) { r.projected = 0; }));
  EXPECT_TRUE(changed([](SimulationReport& r) { r.constraints = 0; }));
  EXPECT_TRUE(changed([](SimulationReport& r) { r.constraints_kept = 0; }));
  EXPECT_TRUE(changed([](SimulationReport& r) { r.power = 0; }));
  EXPECT_TRUE(changed([](SimulationReport& r) { r.smallest_sigma_t = 0; }));
  EXPECT_TRUE(changed([](SimulationReport& r) { r.constraints_each[0].residuals[1] = 0; }));
  EXPECT_TRUE(changed([](SimulationReport& r) { r.error->lost_of = "y"; }));
  EXPECT_TRUE(changed([](SimulationReport& r) { r.events.at(1).stop = false; }));
  EXPECT_TRUE(changed([](SimulationReport& r) { r.eliminations.reset(); }));
  EXPECT_TRUE(changed([](SimulationReport& r) { r.rigorous->times.reset(); }));
}

TEST(ReportJson, IsNoneWhereTheRunHasNotEnded) {
  EXPECT_FALSE(read_report("no JSON").has_value());
  EXPECT_FALSE(read_report("{}").has_value());
  EXPECT_FALSE(read_report(R"({"outcome": "unheard of"})").has_value());
}

// A file of another origin may hold anything: a value of the wrong kind counts as unknown.
TEST(ReportJson, TakesWhatIsThere) {
  const auto r = read_report(R"({"outcome": "finished", "events": 3, "residuals": [], "steps": "many", "order": null,
      "error_estimate": {"digits": 11, "error": 1e-12, "of": "x", "t": 1, "means": "a second run"}, "monitors": {"w": 3}})");
  ASSERT_TRUE(r.has_value());
  EXPECT_TRUE(std::isnan(r->newton));
  EXPECT_FALSE(r->looks_for_events);
  EXPECT_EQ(r->steps, 0U);
  EXPECT_EQ(r->error->worst().digits, 11) << "of an older file, which has no kinds";
  EXPECT_TRUE(std::isnan(r->monitors.at(0).last.value));
}

}  // namespace
}  // namespace anholon::report_json_test
