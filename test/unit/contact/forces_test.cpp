// Forces of contacts in formulas of the model, compared with closed forms. Each test has a mutant or a second way.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "contact/mode/mode_model.h"
#include "support/contact_motion.h"

namespace anholon {
namespace forces_test {

using test::contact_motion;
using test::times;

void expect_near(double a, double b, double relative) { EXPECT_LE(std::abs(a - b), relative * std::abs(b)) << a << b; }

// lambda.NAME and lambda.NAME.t1 of bodies on a slope of the angle 0.3 that falls towards +x.
std::string on_slope(const std::string& shape, const std::string& more) {
  return R"toml(coordinates = ["x", "z", "phi"]
frame.B = "roty(phi)"
gravity.field = "g*(sin(a)*ex - cos(a)*ez)"
parameters = {m = 2, g = 9.81, a = 0.3, mu = 0.5, R = 0.1, push = 0, lift = 0}
define.load = "lambda.floor"
define.grip = "lambda.floor.t1"
[[body]]
name = "body"
mass = "m"
inertia = ["2/5*m*R^2", "2/5*m*R^2", "2/5*m*R^2"]
center = "x*ex + z*ez"
orientation = "B"
[[force]]
on = "body"
vector = "push*ex + lift*t*ez"
[[contact]]
name = "floor"
body = "body"
shape = ")toml" +
         shape + R"toml("
friction = "mu"
[monitor]
N = "load"
T = "grip"
rate = "load'"
used = "grip/load"
[output]
all = "reaction(body)"
both = ["lambda.floor.t1", 0, "2*lambda.floor"]
)toml" + more;
}

TEST(Forces, OfABallThatRolls) {
  const double w = 2 * 9.81;
  const auto misfit = [&](const char* R) {
    const auto m = contact_motion(on_slope("ball(0.1)", "[initial]\nz = 0.1\n"), 1, {{"R", R}});
    EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    EXPECT_EQ(m.last("floor.mode"), 2);
    EXPECT_EQ(m.last("N"), m.last("floor.normal"));
    expect_near(m.last("N"), w * std::cos(0.3), 1e-14);
    expect_near(m.last("both.z"), 2 * w * std::cos(0.3), 1e-14);
    EXPECT_EQ(m.last("both.x"), m.last("T"));
    // Newton's law gives the force without formulas of contacts.
    expect_near(m.last("all.x"), m.last("T"), 1e-13);
    expect_near(m.last("all.z"), m.last("N"), 1e-13);
    return std::abs(m.last("T") + 2.0 / 7 * w * std::sin(0.3));
  };
  EXPECT_LT(misfit("0.1"), 1e-13);
  EXPECT_GT(misfit("0.12"), 1e-2);  // the mutant: more inertia
}

TEST(Forces, OfABlockThatHoldsOrSlides) {
  const double w = 2 * 9.81, N = w * std::cos(0.3);
  const auto slides = [&](const char* mu, const char* push) {
    const auto m = contact_motion(on_slope("point", ""), 1, {{"mu", mu}, {"push", push}});
    EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    expect_near(m.last("N"), N, 1e-14);
    expect_near(m.last("all.x"), m.last("T"), 1e-13);
    return m.last("T");
  };
  expect_near(slides("0.5", "0"), -w * std::sin(0.3), 1e-14);  // holds
  expect_near(slides("0.2", "0"), -0.2 * N, 1e-14);            // down the slope
  expect_near(slides("0.2", "-20"), 0.2 * N, 1e-14);           // up the slope
  EXPECT_GT(std::abs(slides("0.21", "0") + 0.2 * N), 1e-2);    // the mutant
}

TEST(Forces, OfAnOpenContactAreZeroAndEventsFindThem) {
  const std::string event = "[[event]]\nname = \"light\"\nwhen = \"lambda.floor - 5\"\n";
  const auto m = contact_motion(on_slope("point", event), 4, {{"a", "0"}, {"lift", "10"}}, {0, 1, 4});
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  expect_near(m.number(1, "N"), 2 * 9.81 - 10, 1e-14);
  expect_near(m.number(1, "rate"), -10, 1e-14);
  EXPECT_EQ(m.last("N"), 0);
  EXPECT_EQ(m.last("rate"), 0);
  const auto found = times(m, "light");
  ASSERT_EQ(found.size(), 1U);
  expect_near(found[0], (2 * 9.81 - 5) / 10, 1e-14);
  expect_near(times(m, "floor.leaves").at(0), 2 * 9.81 / 10, 1e-14);
}

TEST(Forces, QuotientOfForcesIsNotANumberWhileTheContactIsOpen) {
  const auto m = contact_motion(on_slope("point", ""), 4, {{"lift", "10"}}, {0, 1, 4});
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  expect_near(m.number(0, "used"), -std::tan(0.3), 1e-14);
  EXPECT_EQ(m.last("N"), 0);
  EXPECT_TRUE(std::isnan(m.last("used")));
}

// In space the friction of a slip has two components, and a moment of resistance has a name of its own.
TEST(Forces, InSpace) {
  const auto m = contact_motion(R"toml(coordinates = ["x", "y", "z", "q0", "q1", "q2", "q3"]
gravity.field = "-9.81*ez"
[[body]]
name = "ball"
mass = 2
shape = "ball(0.1)"
center = "x*ex + y*ey + z*ez"
orientation = "quat(q0, q1, q2, q3)"
[[contact]]
name = "floor"
body = "ball"
friction = 0.2
drilling_resistance = 0.003
[monitor]
N = "lambda.floor"
X = "lambda.floor.t1"
Y = "lambda.floor.t2"
M = "lambda.floor.drilling.t1"
[initial]
z = 0.1
q0 = 1
"x'" = 3
"y'" = 4
"q3'" = 4
)toml",
                                Rational(1, 10));
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  const double w = 2 * 9.81;
  expect_near(m.number(0, "N"), w, 1e-14);
  expect_near(m.number(0, "X"), -0.2 * w * 0.6, 1e-14);
  expect_near(m.number(0, "Y"), -0.2 * w * 0.8, 1e-14);
  expect_near(m.number(0, "M"), -0.003 * w, 1e-14);
}

// In a mode with ideal forces, the model of this mode moves as the contacts do, and its multipliers are their forces.
TEST(Forces, OfTheModelOfAMode) {
  const auto last = [](const std::vector<Touch>& touches, const char* inertia) {
    const std::string text = on_slope("ball(0.1)", "[initial]\nz = 0.1\n");
    const SourceText source{"test.toml", text};
    Diagnostics diagnostics;
    const auto open = open_model(source, diagnostics, {{"R", inertia}});
    if (!open) throw std::runtime_error(diagnostics.print(source));
    Scenario s;
    const auto model = clone(*open->model);
    put_ideal_mode(*model, contacts(*open->names), touches);
    const Outcome made = make_scenario(model, *find_formulation("routh"), {}, s);
    if (!made.ok()) throw std::runtime_error(made.message);
    SimulationOptions o;
    o.to = Rational(1);
    test::Motion m;
    m.report = simulate(s, o, m.rows);
    return std::array<double, 4>{m.last("x"), m.last("N"), m.last("T"), m.last("both.z")};
  };
  const auto m = contact_motion(on_slope("ball(0.1)", "[initial]\nz = 0.1\n"), 1);
  const auto rolls = last({Touch::sticks}, "0.1");
  expect_near(rolls[0], m.last("x"), 1e-13);
  expect_near(rolls[1], m.last("N"), 1e-13);
  expect_near(rolls[2], m.last("T"), 1e-13);
  expect_near(rolls[3], 2 * rolls[1], 1e-14);
  EXPECT_GT(std::abs(last({Touch::sticks}, "0.12")[0] - rolls[0]), 1e-2);  // the mutant: more inertia
  EXPECT_EQ(last({Touch::open}, "0.1")[1], 0);
  EXPECT_THROW(last({Touch::slips}, "0.1"), Failure);
}

// The force of a one-sided constraint has the name of the constraint.
TEST(Forces, OfAConstraintOfOneSide) {
  const auto m = contact_motion(R"toml(coordinates = ["z"]
gravity.field = "-9.81*ez"
particle = [{name = "P", mass = 3, position = "z*ez"}]
constraint = [{name = "floor", equation = "z = 0", one_sided = true}]
monitor.N = "lambda.floor"
initial.z = 1
)toml",
                                1, {}, {0, 1});
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  EXPECT_EQ(m.number(0, "N"), 0);
  expect_near(m.last("N"), 3 * 9.81, 1e-14);
}

}  // namespace forces_test
}  // namespace anholon
