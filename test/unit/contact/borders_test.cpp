// Surfaces of contacts with kinks and jumps: a ramp, the edge of a table, and a belt or a lift whose speed jumps.
#include <cmath>

#include <gtest/gtest.h>

#include "support/contact_motion.h"

namespace anholon {
namespace borders_test {

using test::contact_motion;
using test::times;

std::string puck(const std::string& contact, const std::string& initial = "") {
  return R"toml(coordinates = ["x", "z"]
parameters = {m = 1, g = 10, e = 0.5, k = 1, mu = 0.2, V = 2}
particle = [{name = "puck", mass = "m", position = "x*ex + z*ez"}]
gravity.field = "-g*ez"
)toml" + contact +
         "\n[initial]\n" + initial;
}

test::Motion ok_motion(const std::string& text, const Rational& to, const Overrides& overrides = {}) {
  test::Motion m = contact_motion(text, to, overrides);
  EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  EXPECT_TRUE(m.report.warnings.empty());
  return m;
}

TEST(Borders, RampIsStruckWithItsRestitution) {
  const std::string text = puck(R"toml(contact = [{name = "ground", gap = "z - max(0, k*x)", restitution = "e"}])toml",
                                "x = -0.5\n\"x'\" = 2\n");
  const auto m = ok_motion(text, Rational(13, 50));
  EXPECT_EQ(times(m, "ground.hits"), std::vector<double>{0.25});
  EXPECT_TRUE(times(m, "ground.leaves").empty());
  // (x', z') = (2, 0) - (1 + e)/2 n.v n with n = (-1, 1).
  EXPECT_NEAR(m.last("x'"), 0.5, 1e-14);
  EXPECT_NEAR(m.last("z'"), 1.5 - 10 * 0.01, 1e-14);
  // Mutant: a ramp without restitution keeps the velocity along it.
  const auto soft = ok_motion(text, Rational(1, 2), {{"e", "0"}, {"g", "0"}});
  EXPECT_NEAR(soft.last("x'"), 1, 1e-14);
}

TEST(Borders, PuckFliesOffTheEdgeOfATable) {
  const auto m = ok_motion(
      puck(R"toml(contact = [{name = "ground", gap = "z + piecewise(x < 0, 0, k*x)"}])toml", "x = -0.5\n\"x'\" = 2\n"),
      Rational(1, 2));
  EXPECT_EQ(times(m, "ground.leaves"), std::vector<double>{0.25});
  EXPECT_NEAR(m.last("x"), 0.5, 1e-14);
  EXPECT_NEAR(m.last("z"), -5 * 0.0625, 1e-14);
}

TEST(Borders, SmoothBordersChangeNothing) {
  const auto m =
      ok_motion(puck(R"toml(contact = [{name = "ground", gap = "z - k*max(0, x)^3"}])toml", "x = -0.5\n\"x'\" = 2\n"),
                Rational(1, 2));
  EXPECT_TRUE(m.report.events.empty());
  EXPECT_NEAR(m.last("x'") * m.last("x'") + m.last("z'") * m.last("z'") + 20 * m.last("z"), 4, 1e-12);
}

TEST(Borders, BlockSlipsWhereItsBeltJumpsToAnotherSpeed) {
  const std::string contact =
      R"toml(contact = [{name = "belt", gap = "z", slip = "x' - piecewise(t < 1, 1, 3)", friction = "mu"}])toml";
  const auto m = ok_motion(puck(contact), Rational(5, 2));
  EXPECT_EQ(times(m, "belt.slips"), std::vector<double>{1});
  ASSERT_EQ(times(m, "belt.sticks").size(), 2U);
  EXPECT_NEAR(times(m, "belt.sticks")[1], 2, 1e-13);
  EXPECT_NEAR(m.last("x"), 4.25, 1e-13);
  EXPECT_NEAR(m.last("x'"), 3, 1e-14);
}

TEST(Borders, TableOfStepsIsABeltThatJumps) {
  const std::string contact = R"toml(contact = [{name = "belt", gap = "z", slip = "x' - speed(t)", friction = "mu"}]
[[table]]
name = "speed"
x = [0, 1]
y = [1, 3]
fit = "hold")toml";
  const auto m = ok_motion(puck(contact), Rational(5, 2));
  EXPECT_EQ(times(m, "belt.slips"), std::vector<double>{1});
  EXPECT_NEAR(m.last("x"), 4.25, 1e-13);
}

TEST(Borders, FrictionTurnsRoundWithTheBelt) {
  const std::string contact =
      R"toml(contact = [{name = "belt", gap = "z", slip = "x' - piecewise(t < 0.2, 1, -3)", friction = "mu"}])toml";
  const auto m = ok_motion(puck(contact), 2);
  EXPECT_EQ(times(m, "belt.reverses"), std::vector<double>{0.2});
  ASSERT_EQ(times(m, "belt.sticks").size(), 1U);
  EXPECT_NEAR(times(m, "belt.sticks")[0], 1.9, 1e-13);
  const std::string wave =
      R"toml(contact = [{name = "belt", gap = "z", slip = "x' - sign(sin(2*pi*t))", friction = "mu"}])toml";
  const auto w = ok_motion(puck(wave), 4);
  EXPECT_EQ(times(w, "belt.reverses").size(), 2U);
  EXPECT_NEAR(w.last("x"), -0.25, 1e-12);
}

TEST(Borders, LiftThatStartsAtOnceThrowsOrDropsWhatStandsOnIt) {
  const std::string contact =
      R"toml(contact = [{name = "floor", gap = "z - piecewise(t < 1, 0, V*(t - 1))", restitution = "e"}])toml";
  const auto up = ok_motion(puck(contact), Rational(11, 10));
  EXPECT_EQ(times(up, "floor.hits"), std::vector<double>{1});
  EXPECT_NEAR(up.last("z'"), 3 - 1, 1e-13);
  const auto down = ok_motion(puck(contact), Rational(11, 10), {{"V", "-2"}});
  EXPECT_EQ(times(down, "floor.leaves"), std::vector<double>{1});
  EXPECT_NEAR(down.last("z'"), -1, 1e-13);
}

TEST(Borders, FloorThatJumpsDropsABodyAndHasNoVelocityToStrikeIt) {
  const std::string contact = R"toml(contact = [{name = "floor", gap = "z - piecewise(t < 1, 0, V)"}])toml";
  const auto down = ok_motion(puck(contact), Rational(11, 10), {{"V", "-1"}});
  EXPECT_EQ(times(down, "floor.leaves"), std::vector<double>{1});
  EXPECT_NEAR(down.last("z"), -0.05, 1e-14);
  const auto up = contact_motion(puck(contact), 2);
  EXPECT_EQ(up.report.outcome.kind, OutcomeKind::inconsistent);
  EXPECT_NE(up.report.outcome.message.find("where its surface jumps"), std::string::npos);
}

TEST(Borders, NoContactHoldsABodyInAnEdge) {
  const std::string contact = R"toml(contact = [{name = "ground", gap = "z - abs(x)", restitution = "e"}])toml";
  for (const char* e : {"0", "0.5"}) {
    const auto m = contact_motion(puck(contact, "x = -1\nz = 1\n"), 3, {{"e", e}});
    EXPECT_EQ(m.report.outcome.kind, OutcomeKind::inconsistent);
    EXPECT_NE(m.report.outcome.message.find("held by an edge"), std::string::npos);
  }
  // Without loss the motion continues for ever.
  const auto m = ok_motion(puck(contact, "x = -1\nz = 1\n"), 3, {{"e", "1"}});
  EXPECT_EQ(times(m, "ground.hits").size(), 2U);
}

// A ridge that points upwards has no normal for a body that strikes it head-on or lies on it.
TEST(Borders, RidgeHasNoNormal) {
  const std::string ridge =
      R"toml(contact = [{name = "ridge", gap = "z + k*abs(x)", slip = "x'", friction = "mu"}])toml";
  for (const char* z : {"1", "0"}) {
    const auto m = contact_motion(puck(ridge, "z = " + std::string(z)), 1);
    EXPECT_EQ(m.report.outcome.kind, OutcomeKind::inconsistent) << z;
    EXPECT_NE(m.report.outcome.message.find("meets an edge of the surface of contact 'ridge'"), std::string::npos);
    EXPECT_EQ(m.report.outcome.place.line, 5U);
  }
  // The mutants: the body strikes beside the ridge, moves across it, or strikes a rounded ridge.
  EXPECT_TRUE(contact_motion(puck(ridge, "x = 1e-3\nz = 1"), 1).report.outcome.ok());
  EXPECT_TRUE(contact_motion(puck(ridge, "x = -1e-3\nz = 1\n\"x'\" = 1"), 1).report.outcome.ok());
  const auto round = contact_motion(puck(R"toml(contact = [{name = "ridge", gap = "z + k*sqrt(x^2 + 1e-4)"}])toml"), 1);
  EXPECT_TRUE(round.report.outcome.ok()) << round.report.outcome.message;
}

TEST(Borders, ApexOfAConeHasNoNormal) {
  const auto m = contact_motion(puck(R"toml(contact = [{name = "cone", gap = "z + sqrt(x^2)"}])toml", "z = 1"), 1);
  EXPECT_EQ(m.report.outcome.kind, OutcomeKind::singular);
  EXPECT_NE(m.report.outcome.message.find("as at the apex of a cone"), std::string::npos) << m.report.outcome.message;
  EXPECT_NE(m.report.outcome.hint.find("round the apex"), std::string::npos) << m.report.outcome.hint;
  EXPECT_EQ(m.report.outcome.place.line, 5U);
}

TEST(Borders, DiscThatFallsFlatEndsByName) {
  const auto m = contact_motion(R"toml(coordinates = ["x", "y", "z", "a", "b", "c", "d"]
parameters = {m = 0.4, R = 0.0375, g = 9.81, mu = 0.4, th0 = 0.5}
gravity.field = "-g*ez"
body = [{name = "disc", mass = "m", shape = "disc(R)", center = "x*ex+y*ey+z*ez", orientation = "quat(a,b,c,d)"}]
contact = [{name = "floor", body = "disc", friction = "mu"}]
[initial]
a = "cos(th0/2)"
b = "sin(th0/2)"
z = "R*sin(th0)"
)toml",
                                1);
  EXPECT_EQ(m.report.outcome.kind, OutcomeKind::singular);
  EXPECT_NE(m.report.outcome.message.find("a disc lies flat"), std::string::npos) << m.report.outcome.message;
}

// The changes of the disc's modes accumulate at the time at which it lies flat; resistance ends its spin before.
TEST(Borders, EulersDiscIsFollowedToItsEnd) {
  const auto m = contact_motion(R"toml(coordinates = ["x", "y", "z", "a", "b", "c", "d"]
parameters = {m = 0.4, R = 0.0375, g = 9.81, mu = 0.4, dl = 0.01, th0 = 0.5, W = 40}
gravity.field = "-g*ez"
body = [{name = "disc", mass = "m", shape = "disc(R)", center = "x*ex+y*ey+z*ez", orientation = "quat(a,b,c,d)"}]
contact = [{name = "floor", body = "disc", friction = "mu", rolling_resistance = "dl"}]
[initial]
a = "cos(th0/2)"
b = "sin(th0/2)"
z = "R*sin(th0)"
conditions = ["angvel(disc) = W*ez - W*cos(th0)*disc.z"]
)toml",
                                10);
  EXPECT_EQ(m.report.outcome.kind, OutcomeKind::singular);
  EXPECT_NE(m.report.outcome.message.find("a disc lies flat"), std::string::npos) << m.report.outcome.message;
  EXPECT_GT(m.report.t, 0.236);
}

}  // namespace borders_test
}  // namespace anholon
