// The order of events of contacts at one instant.
#include <algorithm>

#include <gtest/gtest.h>

#include "contact/joined_report.h"
#include "support/contact_motion.h"

namespace anholon {
namespace joined_report_test {

std::vector<std::string> names(const SimulationReport& r) {
  std::vector<std::string> list;
  for (const EventReport& e : r.events) list.push_back(e.name);
  return list;
}

std::vector<Contact> named(const char* first, const char* second) {
  std::vector<Contact> contacts(2);
  contacts[0].name = first, contacts[1].name = second;
  return contacts;
}

TEST(JoinedReport, EventsOfOneInstantAreListedByCause) {
  Model model;
  const std::vector<Contact> contacts = named("floor", "floor.rolling");
  JoinedReport joined(model, contacts);
  joined.event("floor.rests", 1);
  joined.event("floor.sticks", 2);
  for (const char* name : {"floor.rests", "floor.rolling.stops", "half", "floor.sticks", "floor.hits"})
    joined.event(name, 3);
  joined.event("floor.hits", 4);
  // Events of the model and events of other instants keep their places.
  const std::vector<std::string> wanted = {"floor.rests", "floor.sticks", "floor.hits",  "floor.rolling.stops",
                                           "half",        "floor.sticks", "floor.rests", "floor.hits"};
  EXPECT_EQ(names(joined.report({}, 5, 0)), wanted);
}

TEST(JoinedReport, AnImpactIsToldWithItsOwnEvent) {
  Model model;
  const std::vector<Contact> contacts = named("b", "a");
  JoinedReport joined(model, contacts);
  joined.event("b.hits", 1);
  joined.event("a.sticks", 1);
  joined.set(1, {{"z'", {-10, ""}, {0, ""}}}, "b.hits");
  const SimulationReport r = joined.report({}, 2, 0);
  ASSERT_EQ(names(r), (std::vector<std::string>{"b.hits", "a.sticks"}));
  EXPECT_EQ(r.events[0].changes.size(), 1U);
  EXPECT_TRUE(r.events[1].changes.empty());
}

// Progress counts the steps of all segments, not only those of the present one.
TEST(JoinedReport, ProgressIsThatOfTheWholeMotion) {
  std::vector<std::size_t> steps;
  std::vector<double> t;
  const test::Motion m = test::contact_motion(
      R"toml(coordinates = ["z"]
gravity.field = "-10*ez"
body = [{name = "ball", mass = 1, shape = "ball(0.1)", center = "z*ez", orientation = "rotz(0)"}]
contact = [{name = "floor", body = "ball", restitution = 0.9}]
initial = {z = 1.1}
)toml",
      3, {}, {}, SimulationOptions().tolerance, [&](double at, std::size_t count) {
        t.push_back(at);
        steps.push_back(count);
      });
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  ASSERT_GT(test::times(m, "floor.hits").size(), 2U);
  EXPECT_TRUE(std::is_sorted(t.begin(), t.end()));
  EXPECT_TRUE(std::is_sorted(steps.begin(), steps.end()));
  EXPECT_EQ(steps.back(), m.report.steps);
}

// A user knows no constraints NAME.gap and NAME.slip1.
TEST(JoinedReport, AnOutcomeNamesTheContact) {
  Model model;
  const std::vector<Contact> contacts = named("floor", "f");
  const auto told = [&](const std::string& message, const std::string& hint = "") {
    JoinedReport joined(model, contacts);
    return joined.report({OutcomeKind::singular, message, hint}, 1, 0).outcome;
  };
  const Outcome o = told("the constraint 'floor.gap' has lost its hold", "write the constraint in another form");
  EXPECT_EQ(o.message, "the contact 'floor' has lost its hold");
  EXPECT_EQ(o.hint, "write the contact in another form");
  EXPECT_EQ(told("the constraint 'f.slip1' has lost its hold").message,
            "the slip of the contact 'f' has lost its hold");
  const Outcome other = told("the constraint 'rod' has lost its hold", "write the constraint in another form");
  EXPECT_EQ(other.message, "the constraint 'rod' has lost its hold");
  EXPECT_EQ(other.hint, "write the constraint in another form");
}

// The momentum of two carts is zero up to round-off, before and after impacts; its change is relative to its terms.
TEST(JoinedReport, ASumThatIsZeroIsComparedWithItsTerms) {
  const test::Motion m = test::contact_motion(R"toml(coordinates = ["x", "y"]
particle = [{name = "a", mass = 1, position = "x*ex"}, {name = "b", mass = 3, position = "y*ex"}]
force = [{on = "b", from = "a", vector = "-2*(y - x - 1)*ex"}]
contact = [{name = "c", gap = "y - x - 0.8", restitution = 0.7}]
output.P = {value = "x' + 3*y'", conserved = true}
initial = {y = 1.3, "x'" = 3, "y'" = -1}
)toml",
                                              4);
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  ASSERT_EQ(test::times(m, "c.hits").size(), 2U);
  ASSERT_EQ(m.report.conserved.size(), 1U);
  EXPECT_LT(m.report.conserved[0].largest_change, 1e-14);
  EXPECT_GT(m.report.conserved[0].size, 6);
  EXPECT_TRUE(m.report.warnings.empty()) << m.report.warnings[0].message;
}

// The impact of one foot opens the contact of the standing foot.
TEST(JoinedReport, AnImpactOpensAnotherContact) {
  const auto wheel = [](const std::string& restitution) {
    return test::contact_motion(R"toml(coordinates = ["x", "z", "phi"]
parameters = {l = 1, a = 0.4, slope = 0.1}
gravity.field = "10*(sin(slope)*ex - cos(slope)*ez)"
body = [{name = "wheel", mass = 1, inertia = [0.1, 0.1, 0.1], center = "x*ex + z*ez", orientation = "roty(phi)"}]
[point]
back = "wheel.center + wheel(-l*sin(a), 0, -l*cos(a))"
front = "wheel.center + wheel(l*sin(a), 0, -l*cos(a))"
[[contact]]
name = "b"
body = "wheel"
at = "back"
friction = 5
restitution = )toml" + restitution + R"toml(
[[contact]]
name = "f"
body = "wheel"
at = "front"
friction = 5
restitution = )toml" + restitution + R"toml(
[initial]
z = "l*cos(a - 0.1)"
x = 0
phi = -0.1
"phi'" = 2
conditions = ["vel(wheel, back) = 0"]
)toml",
                                Rational(2, 5));
  };
  const test::Motion m = wheel("0");
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  const std::vector<double> hits = test::times(m, "f.hits"), leaves = test::times(m, "b.leaves");
  ASSERT_FALSE(hits.empty());
  ASSERT_FALSE(leaves.empty());
  EXPECT_EQ(hits[0], leaves[0]);
  EXPECT_TRUE(test::times(m, "f.leaves").empty());
}

}  // namespace joined_report_test
}  // namespace anholon
