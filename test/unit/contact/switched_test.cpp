// Constraints that hold in some modes, compared with closed forms. Each law has a mutant, a model with other constants,
// whose motion differs.
#include <cmath>

#include <gtest/gtest.h>

#include "support/contact_motion.h"

namespace anholon {
namespace switched_test {

using test::contact_motion;
using test::times;

void expect_near(double a, double b, double relative) {
  EXPECT_LE(std::abs(a - b), relative * std::abs(b)) << a << " " << b;
}

// A ball that falls from the height 0 at the distance h < l and is caught by a string of the length l.
std::string caught(const std::string& more = "") {
  return R"toml(coordinates = ["x", "z"]
parameters = {m = 0.5, g = 9.81, l = 1, h = 0.6}
mode.taut = 0
gravity.field = "-g*ez"
particle = [{name = "ball", mass = "m", position = "x*ex + z*ez"}]
constraint = [{name = "string", equation = "norm(ball) = l", active = "taut"}]
[[event]]
name = "tightens"
when = "norm(ball) - l"
direction = "up"
set = {taut = 1}
[[event]]
name = "slackens"
when = "lambda.string"
direction = "up"
set = {taut = 0}
[monitor]
energy = "m*(x'^2 + z'^2)/2 + m*g*z"
pull = "-lambda.string"
[initial]
x = "h"
)toml" + more;
}

// The ball loses the energy m v^2/2 of its velocity v along the string and no other.
TEST(Switched, EnergyLostAtTheCatchIsThatAlongTheString) {
  const auto misfit = [](double h, double told) {
    const auto m = contact_motion(caught(), 2, {{"h", std::to_string(h)}});
    EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    const double s = std::sqrt(1 - told * told), v = std::sqrt(2 * 9.81 * s);
    EXPECT_EQ(times(m, "tightens").size(), 1U);
    double lost = 0;
    for (std::size_t k = 1; k < m.rows.rows().size(); ++k)
      lost = std::max(lost, m.number(k - 1, "energy") - m.number(k, "energy"));
    return std::abs(lost - 0.5 / 2 * v * v * s * s) + std::abs(m.last("energy") + lost);
  };
  for (const double h : {0.2, 0.6, 0.95}) EXPECT_LT(misfit(h, h), 1e-13) << h;
  EXPECT_GT(misfit(0.61, 0.6), 1e-2);  // the mutant
}

TEST(Switched, CatchTakesPlaceWhereTheStringIsTaut) {
  const auto m = contact_motion(caught(), 2);
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  const auto list = times(m, "tightens");
  ASSERT_EQ(list.size(), 1U);
  expect_near(list[0], std::sqrt(2 * 0.8 / 9.81), 1e-14);
  // The string holds the ball and pulls; before the catch it has no force.
  EXPECT_EQ(m.number(0, "string.active"), 0);
  EXPECT_EQ(m.number(0, "lambda.string"), 0);
  EXPECT_EQ(m.last("string.active"), 1);
  EXPECT_EQ(m.last("lambda.string"), -m.last("pull"));
  for (std::size_t k = 0; k < m.rows.rows().size(); ++k) {
    if (m.number(k, "string.active") != 1) continue;
    EXPECT_NEAR(std::hypot(m.number(k, "x"), m.number(k, "z")), 1, 1e-15);
    EXPECT_GT(m.number(k, "pull"), 0);
  }
}

// With too little speed for a whole turn the string slackens above the centre and later catches the ball again. The
// ball becomes free at v^2 = -g z, at the height (v0^2 + 2 g z0)/(3 g) for the velocity v0 at z0.
TEST(Switched, SlackStringLetsGo) {
  std::string text = caught("z = -0.8\n\"x'\" = 4.4\n\"z'\" = 3.3\n");
  text.replace(text.find("taut = 0"), 8, "taut = 1");
  const auto swing = contact_motion(text, 2);
  ASSERT_TRUE(swing.report.outcome.ok()) << swing.report.outcome.message;
  ASSERT_FALSE(times(swing, "tightens").empty());
  ASSERT_FALSE(times(swing, "slackens").empty());
  std::size_t k = 0;
  while (swing.number(k, "string.active") == 1) ++k;
  expect_near(swing.number(k, "z"), (5.5 * 5.5 - 2 * 9.81 * 0.8) / (3 * 9.81), 1e-12);
  for (k = 1; k < swing.rows.rows().size(); ++k) {
    EXPECT_LE(swing.number(k, "energy"), swing.number(k - 1, "energy") + 1e-13);
    EXPECT_LE(std::hypot(swing.number(k, "x"), swing.number(k, "z")), 1 + 1e-13);
  }
}

// A pendulum whose string of the length l meets a peg at the depth d loses no energy. Each half of the swing has the
// period of its own length; for small angles the whole period is pi (sqrt(l/g) + sqrt((l - d)/g)).
TEST(Switched, PegShortensAPendulum) {
  const std::string text = R"toml(coordinates = ["x", "z"]
parameters = {m = 0.2, g = 9.81, l = 1, d = 0.6, alpha = 1e-4}
mode.caught = 0
gravity.field = "-g*ez"
particle = [{name = "ball", mass = "m", position = "x*ex + z*ez"}]
point.peg = "-d*ez"
[[constraint]]
name = "long"
equation = "norm(ball) = l"
active = "1 - caught"
[[constraint]]
name = "short"
equation = "norm(ball - peg) = l - d"
active = "caught"
[[event]]
name = "catch"
when = "x"
direction = "down"
set = {caught = 1}
[[event]]
name = "free"
when = "x"
direction = "up"
set = {caught = 0}
[monitor]
energy = "m*(x'^2 + z'^2)/2 + m*g*z"
[initial]
x = "l*sin(alpha)"
z = "-l*cos(alpha)"
)toml";
  const auto period = [&](const char* d) {
    const auto m = contact_motion(text, 6, {{"d", d}});
    EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    for (std::size_t k = 1; k < m.rows.rows().size(); ++k)
      EXPECT_NEAR(m.number(k, "energy"), m.number(0, "energy"), 1e-14);
    const auto list = times(m, "catch");
    EXPECT_GT(list.size(), 2U);
    return list.at(1) - list.at(0);
  };
  const double formula = M_PI * (std::sqrt(1 / 9.81) + std::sqrt(0.4 / 9.81));
  expect_near(period("0.6"), formula, 1e-8);            // error up to alpha^2/16, and likewise behind the peg
  EXPECT_GT(std::abs(period("0.61") - formula), 1e-3);  // the mutant
}

// A clutch joins two wheels: their angular momentum is kept, and the energy J1 J2 (w1 - w2)^2/(2 (J1 + J2)) is lost.
std::string clutch(const std::string& engaged) {
  return R"toml(coordinates = ["a", "b"]
parameters = {J1 = 1.5, J2 = 2.5, M = 3}
mode.gear = 1
body = [{name = "engine", mass = 1, inertia = ["J1", "J1", "J1"], center = "0*ex", orientation = "rotz(a)"},
        {name = "load", mass = 1, inertia = ["J2", "J2", "J2"], center = "3*ex", orientation = "rotz(b)"}]
force = [{on = "engine", torque = "M*ez"}]
constraint = [{name = "clutch", equation = "a' = 2*b'", active = ")toml" +
         engaged + R"toml("}]
[[event]]
name = "up"
when = "(t - 1)*(t - 2)*(t - 3)"
set = {gear = "gear + 1"}
[monitor]
energy = "J1*a'^2/2 + J2*b'^2/2"
[initial]
"a'" = 10
)toml";
}

TEST(Switched, ClutchOfTwoWheels) {
  const double J1 = 1.5, J2 = 2.5, M = 3, w1 = 10 + M / J1;
  // For a' = 2 b', the impulse S along a' - 2 b' makes this difference zero.
  const double S = w1 / (1 / J1 + 4 / J2), a = w1 - S / J1, b = 2 * S / J2;
  const auto misfit = [&](double told) {
    std::vector<Rational> at = {Rational(3, 2), Rational(5, 2)};
    const auto m = contact_motion(clutch("choose(gear, 0, 1, 0)"), Rational(5, 2), {{"J1", std::to_string(told)}}, at);
    EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    EXPECT_EQ(times(m, "up").size(), 2U);
    const double rate = M / (J1 + J2 / 4);  // of a' while joined
    double worst = std::abs(m.number(0, "a'") - (a + rate / 2)) + std::abs(m.number(0, "b'") - (b + rate / 4));
    // The wheels are free again from t = 2 on.
    worst += std::abs(m.last("a'") - (a + rate + M / J1 / 2)) + std::abs(m.last("b'") - (b + rate / 2));
    EXPECT_EQ(m.number(0, "clutch.active"), 1);
    EXPECT_EQ(m.last("clutch.active"), 0);
    return worst + std::abs(m.number(0, "lambda.clutch") + M - J1 * rate);
  };
  EXPECT_LT(misfit(1.5), 1e-13);
  EXPECT_GT(misfit(1.6), 1e-2);  // the mutant
}

// The jump of a random pair of wheels never raises the energy.
TEST(Switched, LeastChangeRaisesNoEnergy) {
  std::uint64_t state = 7;
  const auto random = [&] {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return 0.1 + 3 * static_cast<double>(state >> 11) * 0x1p-53;
  };
  for (int k = 0; k < 20; ++k) {
    const auto m = contact_motion(clutch("choose(gear, 0, 1, 1)"), Rational(3, 2),
                                  {{"J1", std::to_string(random())}, {"J2", std::to_string(random())}, {"M", "0"}});
    ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    EXPECT_LT(m.last("energy"), m.number(0, "energy"));
  }
}

// A string that engages at another length than its own has no motion, and the outcome reports it.
TEST(Switched, ConstraintThatIsNotMetIsAnOutcome) {
  std::string early = caught();
  early.replace(early.find("when = \"norm(ball) - l\""), 23, "when = \"norm(ball) - l + 0.1\"");
  const auto m = contact_motion(early, 2);
  EXPECT_EQ(m.report.outcome.kind, OutcomeKind::inconsistent);
  const bool named = m.report.outcome.message.find("after the event 'tightens'") != std::string::npos &&
                     m.report.outcome.message.find("'string'") != std::string::npos;
  EXPECT_TRUE(named) << m.report.outcome.message;
}

// Rows at given times agree with a motion without rows, and every time has its row.
TEST(Switched, RowsAtTimes) {
  std::vector<Rational> at;
  for (int k = 0; k <= 20; ++k) at.emplace_back(k, 10);
  const auto rows = contact_motion(caught(), 2, {}, at), free = contact_motion(caught(), 2);
  ASSERT_EQ(rows.rows.rows().size(), at.size());
  for (std::size_t k = 0; k < at.size(); ++k) EXPECT_EQ(rows.number(k, "t"), static_cast<double>(k) / 10);
  for (const char* name : {"x", "z", "x'", "z'"}) EXPECT_EQ(rows.last(name), free.last(name));
}

}  // namespace switched_test
}  // namespace anholon
