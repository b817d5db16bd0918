// Motions with contacts, compared with published results of Siconos: rows of reference files of siconos-tutorials,
// examples/mechanics (Apache-2.0). bench/peers/siconos.py names their commits. Each test has a mutant with another
// friction or restitution.
#include <cmath>

#include <gtest/gtest.h>

#include "support/contact_motion.h"
#include "support/models.h"

namespace anholon {
namespace siconos_test {

using test::contact_motion;

struct Value {
  const char* column;
  double siconos, tolerance;
};

// The largest deviation in units of the tolerances.
double deviation(const test::Motion& m, const std::vector<Value>& values) {
  double most = 0;
  for (const Value& v : values) most = std::max(most, std::abs(m.last(v.column) - v.siconos) / v.tolerance);
  return most;
}

std::string changed(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string woodpecker() { return test::file_text(test::source_dir() / "models/contacts/woodpecker.toml"); }

// Woodpecker.ref has steps h = 2e-5 with the mean of the forces. Up to the first impact the error at time t is near h^2
// t/12 times the third derivative: 1e-7 for the angle of the bird, whose third derivative is 5e4, and 5e-6 for its
// rate.
TEST(Siconos, WoodpeckerBeforeTheFirstImpact) {
  const std::vector<Value> values = {{"y", -4.407447581115698e-03, 4e-9},
                                     {"phiM", -0.1036, 1e-15},
                                     {"phiS", -3.929826323558062e-01, 4e-7},
                                     {"phiS'", 1.466756739361719e+01, 4e-5}};
  // Siconos begins with the lower edge 8.8e-7 inside the pole.
  const std::string begun = changed(woodpecker(), "play = 0.0006 ", "play = 0.00060088 ");
  const Rational t(1, 20);
  EXPECT_LT(deviation(contact_motion(begun, t, {}, {t}), values), 1);
  EXPECT_GT(deviation(contact_motion(changed(begun, "mu = 0.3\n", "mu = 0.3001\n"), t, {}, {t}), values), 100);
}

// In Woodpecker.ref an impact is late by up to h, in which the sleeve with 25 rad/s turns on by 5e-4; so the sleeve
// stands with its edges up to 1.5e-4 rad inside the pole, and the spring pushes more. There are five impacts before
// 0.122, ten before 0.29998.
TEST(Siconos, WoodpeckerAfterImpacts) {
  const std::vector<Value> first = {{"y", -1.082597072663672e-02, 1e-4},
                                    {"phiS", -1.173944200965509e-01, 3e-3},
                                    {"y'", -3.179918501605071e-01, 3e-3},
                                    {"phiS'", -6.274865559623931e+00, 3e-2}};
  const std::vector<Value> second = {{"y", -4.134818676833654e-02, 2e-4},
                                     {"phiS", -3.409339755504301e-01, 5e-3},
                                     {"y'", -2.601373307913771e-01, 5e-3},
                                     {"phiS'", -8.327555353239312e+00, 5e-2}};
  const Rational t1(61, 500), t2(14999, 50000);
  EXPECT_LT(deviation(contact_motion(woodpecker(), t1, {}, {t1}), first), 1);
  EXPECT_LT(deviation(contact_motion(woodpecker(), t2, {}, {t2}), second), 1);
  for (const auto& [from, to] : {std::pair{"e  = 0.5 ", "e  = 0.51 "}, std::pair{"mu = 0.3\n", "mu = 0.305\n"}}) {
    const std::string mutant = changed(woodpecker(), from, to);
    EXPECT_GT(deviation(contact_motion(mutant, t1, {}, {t1}), first), 2) << to;
    EXPECT_GT(deviation(contact_motion(mutant, t2, {}, {t2}), second), 2) << to;
  }
}

// The results have the inertia of a block of 1 x 0.5 and the corners of one of 0.2 x 0.1.
std::string block(const std::string& e) {
  return R"toml(coordinates = ["x", "y", "th"]
parameters = {J = "(1 + 0.25)/12", a = 0.1, b = 0.05}
gravity.field = "-9.81*ey"
frame.B = "rotz(th)"
point.C = "x*ex + y*ey"
body = [{name = "block", mass = 1, inertia = ["J", "J", "J"], center = "C", orientation = "B"}]
[[contact]]
name = "left"
gap = "(C - a*B.x - b*B.y).y"
restitution = )toml" +
         e + R"toml(
[[contact]]
name = "right"
gap = "(C + a*B.x - b*B.y).y"
restitution = )toml" +
         e + R"toml(
[initial]
x = "cos(pi/3)/2 - sin(pi/3)/4"
y = "sin(pi/3)/2 + cos(pi/3)/4"
th = "pi/3"
)toml";
}

// RockingBlockED_Lsodar_LZBimpact.ref integrates impacts of single corners in steps of 5e-5 of the impulse, by a law
// that equals Newton's for one contact without friction. The fourth impact is the first one of the right corner.
TEST(Siconos, RockingBlockAfterThreeAndFourImpacts) {
  const std::vector<Value> values = {{"y", 1.128191974939628e-01, 5e-5},
                                     {"th", -4.829609415211609e-01, 5e-5},
                                     {"y'", -9.415000000098087e-01, 3e-4},
                                     {"th'", -3.749474843359462e+00, 3e-4}};
  const Rational t(7, 5);
  const test::Motion m = contact_motion(block("0.8"), t, {}, {t});
  EXPECT_LT(deviation(m, values), 1);
  EXPECT_EQ(test::times(m, "left.hits").size(), 3u);
  EXPECT_GT(deviation(contact_motion(block("0.801"), t, {}, {t}), values), 10);
  const test::Motion next = contact_motion(block("0.8"), Rational(36, 25));
  ASSERT_EQ(test::times(next, "right.hits").size(), 1u);
  EXPECT_NEAR(test::times(next, "right.hits")[0], 1.417522522998370, 5e-5);
}

// In ImpactingStick.ref the energy of this stick is 3.765951 at 1e-4 and 3.766658 at 0.1: Newton's law raises it, by
// friction whose slip reverses. Such an impact ends the motion here.
TEST(Siconos, StickWhoseImpactRaisesTheEnergy) {
  const std::string stick = R"toml(coordinates = ["x", "y", "th"]
gravity.field = "-10*ey"
body = [{name = "stick", mass = 1, inertia = ["1/12", "1/12", "1/12"], center = "x*ex + y*ey", orientation = "rotz(th)"}]
[[contact]]
name = "floor"
gap = "y - cos(th)/2"
slip = "x' + cos(th)*th'/2"
friction = 0.01
restitution = 1
[initial]
conditions = ["x = sin(pi/4)/2", "y = cos(pi/4)/2 + 0.01", "th = pi/4", "x' = -0.5", "y' = 0.1", "th' = 0.1"]
)toml";
  const test::Motion m = contact_motion(stick, Rational(1, 10));
  EXPECT_EQ(m.report.outcome.kind, OutcomeKind::inconsistent);
  EXPECT_NE(m.report.outcome.message.find("raise the energy"), std::string::npos) << m.report.outcome.message;
  EXPECT_NEAR(m.report.t, 0.0603, 1e-4);
  const std::string smooth = changed(stick, "friction = 0.01", "friction = 0");
  EXPECT_TRUE(contact_motion(smooth, Rational(1, 10)).report.outcome.ok());
}

}  // namespace siconos_test
}  // namespace anholon
