// Bodies in corners, grooves and guides, where gaps and constraints alone hold all slip velocities at zero: friction is
// not needed, and the loads are those without friction.
#include <cmath>

#include <gtest/gtest.h>

#include "support/contact_motion.h"

namespace anholon {
namespace corners_test {

using test::contact_motion;

std::string corner(const std::string& force) {
  return R"toml(coordinates = ["x", "z"]
parameters = {mu = 0.3}
gravity.field = "-10*ez"
particle = [{name = "b", mass = 1, position = "x*ex + z*ez"}]
force = [{on = "b", vector = ")toml" +
         force + R"toml("}]
contact = [
  {name = "floor", gap = "z", slip = "x'", friction = "mu"},
  {name = "wall", gap = "-x", slip = "z'", friction = "mu"},
]
state = {J = {rate = "lambda.floor", initial = 0}}
)toml";
}

Overrides with_mu(const std::string& mu) { return {{"mu", mu}}; }

TEST(Corner, CarriesItsLoadsWithoutFriction) {
  for (const char* mu : {"0", "0.3"}) {
    const auto m = contact_motion(corner("0.1*ex"), 1, with_mu(mu));
    ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    EXPECT_NEAR(m.last("floor.normal"), 10, 1e-14);
    EXPECT_NEAR(m.last("wall.normal"), 0.1, 1e-14);
    EXPECT_EQ(m.last("floor.friction"), 0);
    EXPECT_EQ(m.last("wall.friction"), 0);
    EXPECT_NEAR(m.last("J"), 10, 1e-13);
  }
}

// The force turns away from the wall at t = 5; friction holds the body until t = 5 + 10 mu.
TEST(Corner, IsLeftWhenNothingPresses) {
  for (const double mu : {0.0, 0.3}) {
    const auto m = contact_motion(corner("(5 - t)*ex"), 20, with_mu(std::to_string(mu)), {7, 20});
    ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    const double begin = 5 + 10 * mu;
    ASSERT_EQ(test::times(m, "wall.leaves").size(), 1U) << mu;
    EXPECT_NEAR(test::times(m, "wall.leaves")[0], 5, 1e-10);
    ASSERT_EQ(test::times(m, "floor.slips").size(), 1U) << mu;
    EXPECT_NEAR(test::times(m, "floor.slips")[0], begin, 1e-10);
    EXPECT_EQ(test::times(m, "wall.slips").size(), 0U) << mu;
    EXPECT_EQ(m.number(0, "wall.normal"), 0);
    EXPECT_EQ(m.last("wall.normal"), 0);
    EXPECT_EQ(m.last("wall.mode"), 0);
    EXPECT_NEAR(m.last("x"), -std::pow(20 - begin, 3) / 6, 1e-7);
  }
}

// A force t along ex leaves the second plane of a groove at g tan(al); friction holds the body on the first one until
// g tan(al + atan(mu)). On the slope it has the acceleration (t cos - g sin) - mu (t sin + g cos).
TEST(Groove, IsLeftUphill) {
  const std::string text = R"toml(coordinates = ["x", "z"]
parameters = {al = 0.6, be = 0.9, mu = 0}
gravity.field = "-10*ez"
particle = [{name = "b", mass = 1, position = "x*ex + z*ez"}]
contact = [
  {name = "right", gap = "z*cos(al) - x*sin(al)", slip = "x'*cos(al) + z'*sin(al)", friction = "mu"},
  {name = "left", gap = "z*cos(be) + x*sin(be)", slip = "-x'*cos(be) + z'*sin(be)", friction = "mu"},
]
force = [{on = "b", vector = "t*ex"}]
)toml";
  for (const double mu : {0.0, 0.1}) {
    const auto m = contact_motion(text, 12, with_mu(std::to_string(mu)), {6, 12});
    ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    ASSERT_EQ(test::times(m, "left.leaves").size(), 1U) << mu;
    EXPECT_NEAR(test::times(m, "left.leaves")[0], 10 * std::tan(0.6), 1e-10);
    const double begin = 10 * std::tan(0.6 + std::atan(mu)), slope = std::cos(0.6) - mu * std::sin(0.6);
    ASSERT_EQ(test::times(m, "right.slips").size(), 1U);
    EXPECT_NEAR(test::times(m, "right.slips")[0], begin, 1e-10);
    EXPECT_NEAR(m.last("x"), std::cos(0.6) * slope * std::pow(12 - begin, 3) / 6, 1e-8);
    EXPECT_NEAR(m.number(0, "right.normal") * std::cos(0.6) + m.number(0, "left.normal") * std::cos(0.9), 10, 1e-13);
    EXPECT_NEAR(m.number(0, "right.normal") * std::sin(0.6) - m.number(0, "left.normal") * std::sin(0.9), 6, 1e-13);
  }
}

TEST(Corner, OfABoxSharesTheLoads) {
  const auto m = contact_motion(R"toml(coordinates = ["x", "z", "p"]
gravity.field = "-10*ez"
body = [{name = "box", mass = 2, shape = "box(0.4, 1, 0.4)", center = "x*ex + z*ez", orientation = "roty(p)"}]
contact = [
  {name = "floor", body = "box", friction = 0.3},
  {name = "wall", body = "box", normal = "-ex", through = "0.2*ex", friction = 0.3},
]
force = [{on = "box", vector = "ex"}]
initial = {z = 0.2}
)toml",
                                1);
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  for (const char* foot : {"floor1.normal", "floor2.normal"}) EXPECT_NEAR(m.last(foot), 10, 1e-12) << foot;
  for (const char* side : {"wall2.normal", "wall4.normal"}) EXPECT_NEAR(m.last(side), 0.5, 1e-12) << side;
}

TEST(Guide, TakesTheForceAcrossIt) {
  const auto m = contact_motion(R"toml(coordinates = ["x", "z"]
gravity.field = "-10*ez"
particle = [{name = "b", mass = 1, position = "x*ex + z*ez"}]
constraint = [{name = "rail", equation = "x = 0"}]
contact = [{name = "floor", gap = "z", slip = "x'", friction = 0.1}]
force = [{on = "b", vector = "50*ex"}]
)toml",
                                1);
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  EXPECT_EQ(m.last("floor.friction"), 0);
  EXPECT_NEAR(m.last("floor.normal"), 10, 1e-13);
  EXPECT_NEAR(m.last("lambda.rail"), -50, 1e-12);
}

}  // namespace corners_test
}  // namespace anholon
