// An axle that comes down on one ball, then on the other: an impact on a contact that is closed, friction that both
// share.
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "support/contact_motion.h"

namespace anholon {
namespace axle_test {

using test::contact_motion;

std::string axle(const std::string& initial) {
  return R"toml(
coordinates = ["x", "y", "z", "psi", "th", "ro"]
gravity.field = "-9.81*ez"
frame.B = "rotz(psi)*roty(th)*rotx(ro)"
point.P = "x*ex + y*ey + z*ez"
body = [{name = "chassis", mass = 8, inertia = [0.1, 0.15, 0.2], center = "P + 0.05*B.x", orientation = "B"}]
contact = [
  {name = "left", body = "chassis", shape = "ball(0.08)", at = "P + 0.15*B.y", friction = 0.6},
  {name = "right", body = "chassis", shape = "ball(0.08)", at = "P - 0.15*B.y", friction = 0.6},
]
monitor.left_slip = "norm(vel(chassis, P + 0.15*B.y - 0.08*ez))"
monitor.right_slip = "norm(vel(chassis, P - 0.15*B.y - 0.08*ez))"
initial = )toml" +
         initial;
}

// The left ball strikes while the right one slips. Both then stick: the jump is the projection in the mass norm onto
// velocities at which both rest, and there are impulses in both cones. If friction were shared by load alone, the
// impulse of the right ball would leave its cone.
TEST(Axle, SharesFrictionInAnImpact) {
  const auto m = contact_motion(
      axle(R"({z = 0.188, ro = 0.238, th = -0.08, "x'" = 0.3, "th'" = 0.16, "ro'" = 0.29, "psi'" = 0.38})"),
      Rational(181, 1000));
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  const auto hits = test::times(m, "left.hits");
  ASSERT_EQ(hits.size(), 1U);
  EXPECT_NEAR(hits[0], 0.180736634706, 1e-11);
  EXPECT_EQ(m.last("left.mode"), 2);
  EXPECT_EQ(m.last("right.mode"), 2);
  EXPECT_LT(m.last("left_slip"), 1e-13);
  EXPECT_LT(m.last("right_slip"), 1e-13);
  // Computed with NumPy: the projection, and a fixed point of projections of the impulses onto the cones.
  const std::map<std::string, double> jumps = {{"x'", 0.07926868},  {"y'", -0.44364017}, {"z'", 0.83043841},
                                               {"psi'", 0.8037576}, {"th'", 1.71083592}, {"ro'", 5.54947064}};
  for (const EventReport& e : m.report.events)
    for (const EventReport::Change& c : e.changes)
      if (e.name == "left.hits") {
        EXPECT_NEAR(c.after.value - c.before.value, jumps.at(c.name), 1e-8) << c.name;
      }
}

// An axle whose balls both touch is not tilted. Its tilt of 1.4e-16 is round-off, and so is the rate of the tilt.
TEST(Axle, TiltsByRoundOffAlone) {
  const auto m = contact_motion(
      axle(R"({z = 0.272, ro = -0.158, th = 0.28, "x'" = 0.3, "th'" = 3.03, "ro'" = 0.74, "psi'" = -0.2})"),
      Rational(1, 4));
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  EXPECT_EQ(test::times(m, "left.hits").size(), 1U);
  EXPECT_EQ(test::times(m, "right.hits").size(), 1U);
  EXPECT_LT(std::abs(m.last("ro")), 1e-15);
  EXPECT_LT(std::abs(m.last("ro'")), 1e-14);
}

// The balls strike in turn, sooner and sooner. When both come to rest one gap is 1e-13, and the axle is moved to the
// place at which both gaps are zero, where the mode holds them.
TEST(Axle, ComesToLieOnBothBalls) {
  const auto m = contact_motion(
      axle(R"({z = 0.232, ro = 0.175, th = -0.9, "x'" = 0.3, "th'" = -1.12, "ro'" = -0.53, "psi'" = -1.69})"),
      Rational(7, 25));
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  EXPECT_EQ(test::times(m, "left.hits").size(), 4U);
  EXPECT_LT(std::abs(m.last("left.gap")), 1e-16);
  EXPECT_LT(std::abs(m.last("ro")), 1e-15);
  EXPECT_GT(m.last("left.mode") * m.last("right.mode"), 0);
}

// The axle falls over its balls. Its three angles are singular in the hanging position.
TEST(Axle, NamesAnglesAtTheirSingularity) {
  const auto m = contact_motion(axle(R"({z = 0.2, ro = 0.05, "x'" = 0.3, "th'" = -3, "ro'" = 0.2, "psi'" = 0.3})"), 1);
  EXPECT_EQ(m.report.outcome.kind, OutcomeKind::singular);
  EXPECT_NE(m.report.outcome.message.find("the angles psi, th, ro of 'chassis' are near their singularity"),
            std::string::npos)
      << m.report.outcome.message;
  EXPECT_NE(m.report.outcome.hint.find("quaternion"), std::string::npos) << m.report.outcome.hint;
}

}  // namespace axle_test
}  // namespace anholon
