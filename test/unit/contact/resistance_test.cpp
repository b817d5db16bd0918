// Resistance to rolling and drilling, compared with closed forms. Each test has a mutant, a model with other constants,
// whose motion differs.
#include <cmath>

#include <gtest/gtest.h>

#include "support/contact_motion.h"

namespace anholon {
namespace resistance_test {

using test::contact_motion;
using test::times;

constexpr double g = 9.81, R = 0.11;

// A ball or a disc on a slope of the angle `a` that falls towards +x, in the plane y = 0. Its axis z is normal to the
// plane, since a disc turns about it.
std::string rolls(const std::string& inertia, const std::string& shape, const std::string& more) {
  return R"toml(coordinates = ["x", "z", "phi"]
frame.B = "roty(phi)*rotx(pi/2)"
point.C = "x*ex + z*ez"
gravity.field = "g*(sin(a)*ex - cos(a)*ez)"
[parameters]
m = 2
R = 0.11
g = 9.81
a = 0
mu = 0.5
delta = 0.004
v = 0
J = ")toml" +
         inertia + R"toml("
[[body]]
name = "wheel"
mass = "m"
inertia = ["J", "J", "J"]
center = "C"
orientation = "B"
[[contact]]
name = "floor"
body = "wheel"
shape = ")toml" +
         shape + R"toml("
friction = "mu"
rolling_resistance = "delta"
[initial]
z = "R"
"x'" = "v"
"phi'" = "v/R"
)toml" + more;
}

void expect_near(double a, double b, double relative) { EXPECT_LE(std::abs(a - b), relative * std::abs(b)) << a << b; }

const char* const kBall = "2/5*m*R^2";
const char* const kHollow = "2/3*m*R^2";

// The moment delta m g and the friction of rolling slow v by delta g/(R (1 + k)) with J = k m R^2.
TEST(Resistance, BallThatRollsStopsAfterItsPath) {
  const auto misfit = [](const char* inertia, const char* shape, double k, const std::string& delta) {
    const auto m = contact_motion(rolls(inertia, shape, ""), 20, {{"v", "1.5"}, {"delta", delta}});
    EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    const double slow = 0.004 * g / (R * (1 + k)), path = 1.5 * 1.5 / (2 * slow);
    const auto stops = times(m, "floor.rolling.stops");
    EXPECT_EQ(stops.size(), 1U);
    EXPECT_EQ(m.last("x'"), 0);
    EXPECT_EQ(m.last("phi'"), 0);
    EXPECT_EQ(m.last("floor.rolling.mode"), 2);
    EXPECT_LT(m.report.power, 1e-10);
    // The moment, whose size is delta m g up to the stop, takes all energy.
    const double energy = 2 * 1.5 * 1.5 * (1 + k) / 2;
    EXPECT_LE(std::abs(-m.number(0, "floor.rolling.moment") * m.last("phi") - energy), 1e-10 * energy);
    return std::max(std::abs(stops.at(0) * slow / 1.5 - 1), std::abs(m.last("x") / path - 1));
  };
  EXPECT_LT(misfit(kBall, "ball(R)", 2.0 / 5, "0.004"), 1e-12);
  EXPECT_LT(misfit(kHollow, "ball(R)", 2.0 / 3, "0.004"), 1e-12);
  EXPECT_LT(misfit("m*R^2/2", "disc(R)", 1.0 / 2, "0.004"), 1e-12);
  EXPECT_GT(misfit(kBall, "ball(R)", 2.0 / 5, "0.0041"), 1e-2);  // the mutant
}

TEST(Resistance, BallRestsOnASlopeUpToItsAngle) {
  const double limit = std::atan(0.004 / R);
  const auto on = [](double angle) {
    return contact_motion(rolls(kBall, "ball(R)", ""), 2, {{"a", std::to_string(angle)}}, {0, 1, 2});
  };
  for (const double part : {0.5, 0.999}) {
    const auto rests = on(part * limit);
    ASSERT_TRUE(rests.report.outcome.ok()) << rests.report.outcome.message;
    EXPECT_EQ(rests.last("x"), 0);
    EXPECT_EQ(rests.last("x'"), 0);
    EXPECT_EQ(rests.last("phi"), 0);
    EXPECT_EQ(rests.last("floor.rolling.mode"), 2);
  }
  for (const double part : {1.001, 2.0}) {
    const double a = std::stod(std::to_string(part * limit));
    const auto moves = on(part * limit);
    ASSERT_TRUE(moves.report.outcome.ok()) << moves.report.outcome.message;
    expect_near(moves.last("x'"), 2 * g * (std::sin(a) - 0.004 / R * std::cos(a)) / 1.4, 1e-11);
    EXPECT_EQ(moves.last("floor.mode"), 2);
  }
}

// A growing torque begins to roll the ball against friction and resistance.
TEST(Resistance, BallIsSetRollingByAGrowingPush) {
  const std::string push = "[[force]]\non = \"wheel\"\nvector = \"t*ex\"\n";
  const auto m = contact_motion(rolls(kBall, "ball(R)", push), 3);
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  // The moment t R of the push about the lowest point passes delta m g.
  const double begin = 0.004 * 2 * g / R;
  const auto starts = times(m, "floor.rolling.starts");
  ASSERT_EQ(starts.size(), 1U);
  EXPECT_NEAR(starts[0], begin, 1e-11);
  expect_near(m.last("x"), std::pow(3 - begin, 3) / (6 * 1.4 * 2), 1e-10);
  EXPECT_GT(std::abs(contact_motion(rolls(kBall, "ball(R)", push), 3, {{"delta", "0.005"}}).last("x") - m.last("x")),
            1e-3);  // the mutant
}

// A ball in space.
std::string ball(const std::string& start) {
  return R"toml(coordinates = ["x", "y", "z", "q0", "q1", "q2", "q3"]
frame.B = "quat(q0, q1, q2, q3)"
point.C = "x*ex + y*ey + z*ez"
gravity.field = "-g*ez"
[parameters]
m = 2
R = 0.11
g = 9.81
mu = 0.2
delta = 0.004
drill = 0.003
[[body]]
name = "ball"
mass = "m"
shape = "ball(R)"
center = "C"
orientation = "B"
[[contact]]
name = "floor"
body = "ball"
friction = "mu"
rolling_resistance = "delta"
drilling_resistance = "drill"
[initial]
z = "R"
q0 = 1
)toml" + start;
}

// The moment drill m g about the vertical stops the spin w in the time w J/(drill m g).
TEST(Resistance, SpinningBallStops) {
  const auto stop = [](const std::string& drill) {
    const auto m = contact_motion(ball("\"q3'\" = 4\n"), 20, {{"drill", drill}});
    EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    EXPECT_EQ(m.last("x'"), 0);
    EXPECT_LT(m.report.power, 1e-10);
    const auto stops = times(m, "floor.drilling.stops");
    EXPECT_EQ(stops.size(), 1U);
    return stops.at(0);
  };
  const double formula = 8 * 0.4 * R * R / (0.003 * g);
  expect_near(stop("0.003"), formula, 1e-12);
  EXPECT_GT(std::abs(stop("0.0031") - formula), 1e-2);  // the mutant
}

// A ball that slips obliquely with spin about all axes comes to rest: first the slip ends, then rolling and drilling.
// Its energy never grows, and power and rates agree.
TEST(Resistance, BallThrownAskewComesToRest) {
  const auto m = contact_motion(ball("\"x'\" = 2\n\"y'\" = 0.3\n\"q1'\" = 3\n\"q2'\" = -5\n\"q3'\" = 4\n"), 60);
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  ASSERT_EQ(times(m, "floor.sticks").size(), 1U);
  ASSERT_EQ(times(m, "floor.rolling.stops").size(), 1U);
  ASSERT_EQ(times(m, "floor.drilling.stops").size(), 1U);
  EXPECT_LT(m.report.power, 1e-10);
  // From the end of the slip on, the ball rolls straight with the deceleration delta g/(1.4 R).
  const double begin = times(m, "floor.sticks")[0], end = times(m, "floor.rolling.stops")[0];
  for (std::size_t k = 0; k < m.rows.rows().size(); ++k)
    if (m.number(k, "t") == begin) {
      const double v = std::hypot(m.number(k, "x'"), m.number(k, "y'"));
      EXPECT_NEAR(end - begin, v * 1.4 * R / (0.004 * g), 1e-9);
      EXPECT_NEAR(std::hypot(m.last("x") - m.number(k, "x"), m.last("y") - m.number(k, "y")), v * (end - begin) / 2,
                  1e-9);
      break;
    }
  for (const char* q : {"x'", "y'", "q0'", "q1'", "q2'", "q3'"}) EXPECT_EQ(m.last(q), 0) << q;
  EXPECT_LT(m.report.steps, 2000U);
}

// A ball in a bowl swings until it stops at a slope on which the moment holds it. Each segment begins and ends at rest.
TEST(Resistance, BallInABowlRestsNearItsLowestPoint) {
  const auto rest = [](const std::string& delta) {
    const auto m = contact_motion(R"toml(coordinates = ["x", "z", "phi"]
parameters = {delta = 0.003}
gravity.field = "-9.81*ez"
[[body]]
name = "ball"
mass = 1
shape = "ball(0.1)"
center = "x*ex + z*ez"
orientation = "roty(phi)"
[[contact]]
name = "bowl"
body = "ball"
on = "bowl(1)"
friction = 0.5
rolling_resistance = "delta"
[initial]
x = 0.3
guess = {z = -0.8}
conditions = ["x^2 + z^2 = 0.9^2"]
)toml",
                                  30, {{"delta", delta}});
    EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    EXPECT_LT(m.report.power, 1e-10);
    for (const char* column : {"x'", "z'", "phi'"}) EXPECT_LT(std::abs(m.last(column)), 1e-30) << column;
    EXPECT_EQ(m.last("bowl.mode"), 2);
    EXPECT_EQ(m.last("bowl.rolling.mode"), 2);
    // The tangent of the slope; the moment holds the ball up to delta/r.
    EXPECT_LT(std::abs(m.last("x") / m.last("z")), std::stod(delta) / 0.1);
    EXPECT_EQ(times(m, "bowl.rolling.stops").size(), 1U);
    return times(m, "bowl.rolling.reverses").size();
  };
  EXPECT_EQ(rest("0.003"), 5U);
  EXPECT_EQ(rest("0.006"), 2U);  // the mutant
}

// A ball on a smooth floor stops turning: the velocities of its quaternion that remain after the last jump are all set
// to zero.
TEST(Resistance, BallOnASmoothFloorEndsItsTurning) {
  const auto m = contact_motion(R"toml(
coordinates = ["x","y","z","a","b","c","d"]
gravity.field = "-9.81*ez + 0.000*ex"
body=[{name="B",mass=1,shape="ball(0.1)",center="x*ex+y*ey+z*ez",orientation="quat(a,b,c,d)"}]
[initial]
a=1
z = 0.114146
"x'" = 0.259997
"y'" = 2.074455
"z'" = -0.616297
"b'" = 1.619342
"c'" = 3.336354
"d'" = 3.191192
[[contact]]
name="f"
body="B"
friction = 0.0000
restitution = 0.0000
impact = "newton"
rolling_resistance = 0.00853
drilling_resistance = 0.00744
)toml",
                                5);
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  EXPECT_EQ(m.last("f.rolling.mode"), 2);
  EXPECT_LT(m.report.power, 1e-10);
}

// The last stop of a ball with quaternion coordinates leaves a rate along the quaternion that is larger than those that
// turn the ball: the jump that stops it removes this rate, too.
TEST(Resistance, BallEndsRollingAndDrillingTogether) {
  const auto m = contact_motion(R"toml(
coordinates = ["x","y","z","a","b","c","d"]
gravity.field = "-9.81*ez"
body = [{name="B", mass=1, shape="ball(0.1)", center="x*ex+y*ey+z*ez", orientation="quat(a,b,c,d)"}]
[[contact]]
name = "f"
body = "B"
friction = 0.4299946761724623
rolling_resistance = 0.0016204930323988655
drilling_resistance = 0.0006689451258076937
[initial]
a = 1
z = 0.1
"x'" = -2.187652920991212
"z'" = -0.20406550207191887
"b'" = -1.3962150993860414
)toml",
                                20);
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  EXPECT_EQ(m.last("f.rolling.mode"), 2);
  EXPECT_EQ(m.last("f.drilling.mode"), 2);
  for (const char* q : {"x'", "y'", "a'", "b'", "c'", "d'"}) EXPECT_EQ(m.last(q), 0) << q;
  EXPECT_LT(m.report.power, 1e-10);
}

// A belt with the acceleration 2 pulls a spinning ball along, which slips and rolls from the first row on. The slip
// ends at the time 16/27, rolling does not: friction accelerates the ball by mu g and turns it with the arm R against
// the moment.
TEST(Resistance, BallThatABeltPullsAlong) {
  const auto ball = [](const std::string& belt, const std::string& resistance = "rolling_resistance = 0.0005",
                       const Rational& to = 1) {
    return contact_motion(R"toml(coordinates = ["x", "y", "z", "a", "b", "c", "d"]
gravity.field = "-10*ez"
body = [{name = "s", mass = 1, shape = "ball(0.1)", center = "x*ex + y*ey + z*ez", orientation = "quat(a, b, c, d)"}]
contact = [{name = "k", body = "s", friction = 0.1, through = ")toml" +
                              belt + "\", " + resistance + R"toml(}]
initial = {a = 1, z = 0.1, conditions = ["angvel(s).z = 10", "angvel(s).x = 0", "angvel(s).y = 0"]}
)toml",
                          to, {}, {0, to});
  };
  const auto m = ball("2*t*ex");
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  EXPECT_EQ(m.number(0, "k.mode"), 1);
  EXPECT_EQ(m.number(0, "k.rolling.mode"), 1);
  EXPECT_NEAR(m.number(0, "k.rolling.moment"), 0.005, 1e-15);
  EXPECT_EQ(m.last("k.mode"), 2);
  ASSERT_EQ(times(m, "k.sticks").size(), 1U);
  EXPECT_NEAR(times(m, "k.sticks")[0], 16.0 / 27, 1e-12);
  EXPECT_EQ(m.report.events.size(), 1U);
  // With drilling, rolling stays at rest when the slip ends: its velocity and the terms of it are round-off.
  const auto held = ball("2*t*ex", "rolling_resistance = 0.05, drilling_resistance = 0.001", 3);
  ASSERT_TRUE(held.report.outcome.ok()) << held.report.outcome.message;
  ASSERT_EQ(times(held, "k.sticks").size(), 1U);
  EXPECT_NEAR(times(held, "k.sticks")[0], 2, 1e-11);
  EXPECT_NEAR(held.last("x"), 4, 1e-11);
  EXPECT_GT(std::abs(times(ball("2.1*t*ex"), "k.sticks").at(0) - 16.0 / 27), 1e-2);  // the mutant
}

TEST(Resistance, MistakesHavePlaces) {
  const auto refused = [](const std::string& text) {
    try {
      contact_motion(text, 1);
    } catch (const std::runtime_error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const auto says = [&](const std::string& text, const std::string& expected) {
    EXPECT_NE(refused(text).find(expected), std::string::npos) << refused(text);
  };
  says(rolls(kBall, "point", ""), "a point does not roll");
  says(rolls(kBall, "box(1, 1, 1)", ""), "a box does not roll");
  std::string text = rolls(kBall, "ball(R)", "");
  text.replace(text.find("\"delta\"\n"), 8, "\"x\"\n");
  says(text, "is a number or a formula of parameters, and this one changes with 'x'");
  says("coordinates = [\"x\", \"z\"]\nparticle = [{name = \"p\", mass = 1, position = \"x*ex + z*ez\"}]\n[[contact]]\n"
       "body = \"p\"\ndrilling_resistance = 0.1\n",
       "no orientation");
  says("coordinates = [\"x\", \"z\"]\nparticle = [{name = \"p\", mass = 1, position = \"x*ex + z*ez\"}]\n[[contact]]\n"
       "gap = \"z\"\nslip = \"x'\"\nrolling_resistance = 0.1\n",
       "needs the angular velocity of a body");
  text = rolls(kBall, "ball(R)", "");
  text.replace(text.find("rolling_r"), 9, "drilling_r");
  says(text, "never turns about the normal");
}

}  // namespace resistance_test
}  // namespace anholon
