// If constraints are redundant, the constraints that take part are chosen anew on the way.
//
// A coupler hangs on three parallel cranks whose pivots lie on no line: six equations, five of which are independent.
// Any five become dependent somewhere along a turn of the cranks, though the mechanism has no singular position.
#include <cmath>

#include <gtest/gtest.h>

#include "simulation/simulate.h"
#include "support/models.h"
#include "support/rows.h"

namespace anholon::chosen_rows_test {
namespace {

const char* const kCranks = R"toml(
coordinates = ["a", "b", "c", "x", "y", "phi"]
parameters = {g = 10}
frame.C = "rotz(phi)"
point.G = "x*ex + y*ey"
body = [
  {name = "first",  mass = 1, inertia = "1/10", center = "rotz(a).x/2", angle = "a"},
  {name = "second", mass = 1, inertia = "1/10", center = "2*ex + rotz(b).x/2", angle = "b"},
  {name = "third",  mass = 1, inertia = "1/10", center = "ex + ey + rotz(c).x/2", angle = "c"},
  {name = "coupler", mass = 2, inertia = 1, center = "G", angle = "phi"},
]
constraint = [
  {name = "ax", equation = "G.x = cos(a)"},
  {name = "ay", equation = "G.y = sin(a)"},
  {name = "bx", equation = "(G + 2*C.x).x = 2 + cos(b)"},
  {name = "by", equation = "(G + 2*C.x).y = sin(b)"},
  {name = "cx", equation = "(G + C.x + C.y).x = 1 + cos(c)"},
  {name = "cy", equation = "(G + C.x + C.y).y = 1 + sin(c)"},
]
gravity.field = "-g*ey"
[monitor]
tension = "reaction(coupler).x"
[initial]
a = 0.3
b = 0.3
c = 0.3
phi = 0
"a'" = 7
)toml";

// The same motion in one coordinate: (3 (1/10 + 1/4) + 2) a'' = -(3/2 + 2) g cos a.
const char* const kOneCrank = R"toml(
coordinates = ["a"]
parameters = {g = 10}
body = [
  {name = "cranks", mass = 3, inertia = "3/10", center = "rotz(a).x/2", angle = "a"},
]
particle = [{name = "coupler", mass = 2, position = "rotz(a).x"}]
gravity.field = "-g*ey"
[monitor]
tension = "2*acc(rotz(a).x).x"
[initial]
a = 0.3
"a'" = 7
)toml";

struct Result {
  SimulationReport report;
  test::TextRows rows;
  std::string saved;

  double last(const std::string& column) const {
    const auto at = std::find(rows.names().begin(), rows.names().end(), column);
    return std::stod(rows.rows().back()[static_cast<std::size_t>(at - rows.names().begin())]);
  }
};

Result run(const char* text, const char* form, const Rational& to, const SavedRun* resume = nullptr) {
  Scenario s;
  EXPECT_TRUE(make_scenario(test::model_of(text), *find_formulation(form), {}, s).ok());
  SimulationOptions o;
  o.to = to;
  o.every = 1;
  o.resume = resume;
  Result r;
  o.save = [&](const SavedRun& run) { r.saved = print(run); };
  r.report = simulate(s, o, r.rows);
  EXPECT_EQ(r.report.outcome.kind, OutcomeKind::finished) << form << ": " << r.report.outcome.message;
  return r;
}

TEST(ChosenRows, FollowTheMotionThroughEveryTurn) {
  const Result one = run(kOneCrank, "routh", 10);
  ASSERT_GT(std::abs(one.last("a")), 30) << "the cranks turn";
  for (const char* form : {"routh", "maggi", "kane", "udwadia-kalaba"}) {
    SCOPED_TRACE(form);
    const Result r = run(kCranks, form, 10);
    for (const char* angle : {"a", "b", "c"}) EXPECT_NEAR(r.last(angle), one.last("a"), 1e-9);
    EXPECT_NEAR(r.last("phi"), 0, 1e-9);
    EXPECT_NEAR(r.last("x"), std::cos(one.last("a")), 1e-9);
    EXPECT_NEAR(r.last("tension"), one.last("tension"), 1e-7);
    EXPECT_LT(r.report.newton, 1e-13);
    EXPECT_LT(r.report.constraints_kept, 1e-9);
  }
}

// All six multipliers are the least ones, for any five constraints that take part.
TEST(ChosenRows, ChangeNoMultiplier) {
  const Result routh = run(kCranks, "routh", 4), kane = run(kCranks, "kane", 4);
  for (const char* name : {"ax", "ay", "bx", "by", "cx", "cy"}) {
    const std::string column = std::string("lambda.") + name;
    EXPECT_NEAR(routh.last(column), kane.last(column), 1e-8 * std::abs(routh.last(column))) << column;
  }
}

TEST(ChosenRows, AreTheSameInARunThatGoesOn) {
  for (const char* form : {"routh", "kane"}) {
    SCOPED_TRACE(form);
    const Result first = run(kCranks, form, 4), whole = run(kCranks, form, 8);
    const SavedRun saved = read_saved({"run.state", first.saved});
    const Result second = run(kCranks, form, 8, &saved);
    ASSERT_GT(second.rows.rows().size(), 2U);
    EXPECT_EQ(second.rows.rows().back(), whole.rows.rows().back());
  }
}

// The rows agree in the velocities, and the difference of the constraints is z = 0.
TEST(ChosenRows, AreNotRedundantIfTheirDifferenceSaysMore) {
  Scenario s;
  ASSERT_TRUE(make_scenario(test::model_of(R"toml(
coordinates = ["x", "y", "z"]
particle = [{name = "p", mass = 1, position = ["x", "y", "z"]}]
force = [{on = "p", vector = ["1", "0", "1/2"]}]
constraint = [{name = "a", equation = "x' + y' = 0"}, {name = "b", equation = "x' + y' + z = 0"}]
)toml"),
                            *find_formulation("routh"), {}, s)
                  .ok());
  test::TextRows rows;
  SimulationOptions o;
  o.to = 1;
  const SimulationReport report = simulate(s, o, rows);
  EXPECT_EQ(report.outcome.kind, OutcomeKind::singular);
  EXPECT_NE(report.outcome.message.find("'b' does not follow from the others"), std::string::npos)
      << report.outcome.message;
}

}  // namespace
}  // namespace anholon::chosen_rows_test
