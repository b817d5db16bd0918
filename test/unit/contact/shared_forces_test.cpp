// Contacts at rest on one body share their friction: they stick as long as some distribution of the friction lies in
// all cones.
#include <cmath>

#include <gtest/gtest.h>

#include "contact/touching_bodies.h"
#include "support/contact_motion.h"

namespace anholon {
namespace shared_forces_test {

using test::contact_motion;

constexpr double kLimit = 0.3 * 2 * 9.81;  // mu m g

std::string block(const std::string& at, const std::string& right = "") {
  return R"toml(coordinates = ["x", "z", "p"]
parameters = {m = 2, k = 0.3}
gravity.field = "-9.81*ez"
body = [{name = "s", mass = "m", inertia = [0.1, 0.1, 0.1], center = "x*ex + z*ez", orientation = "roty(p)"}]
contact = [
  {name = "l1", body = "s", shape = "point", at = "s.center + s(0.3, 0, -0.1)", friction = "k"},
  {name = "l2", body = "s", shape = "point", at = "s.center + s(-0.3, 0, -0.1)", friction = "k")toml" +
         right + R"toml(},
]
initial = {z = 0.1}
force = [{on = {body = "s", at = )toml" +
         at + "}, vector = \"t*ex\"}]\n";
}

// The force t pushes the block: the block stands until t = mu m g, for any shares of its feet, and then m x'' = t - mu
// m g.
TEST(SharedFriction, BlockOnTwoFeetSlidesWhenBothAreAtTheirLimit) {
  for (const char* at : {"[0, 0, -0.1]", "[0, 0, 0]"}) {
    const auto m = contact_motion(block(at), 8);
    ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    for (const char* event : {"l1.slips", "l2.slips"}) {
      ASSERT_EQ(test::times(m, event).size(), 1U) << event << " " << at;
      EXPECT_NEAR(test::times(m, event)[0], kLimit, 1e-7) << event << " " << at;
    }
    EXPECT_NEAR(m.last("x"), std::pow(8 - kLimit, 3) / 12, 1e-10) << at;
    EXPECT_NEAR(m.last("x'"), std::pow(8 - kLimit, 2) / 4, 1e-10) << at;
  }
}

// The contacts are held for a moment while the search finds the slipping ones; rows in this time show no more friction
// than the bound.
TEST(SharedFriction, IsNeverBeyondItsBound) {
  for (const Rational& late : {Rational(1, 10'000'000), Rational(1, 2'000'000), Rational(9, 10'000'000)}) {
    const auto m = contact_motion(block("[0, 0, 0]"), 6, {}, {Rational(5886, 1000) + late});
    ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    for (const std::string foot : {"l1", "l2"}) {
      const double bound = 0.3 * m.number(0, foot + ".normal");
      EXPECT_NEAR(std::abs(m.number(0, foot + ".friction")), bound, 1e-12 * bound) << foot << " " << late.get_d();
    }
  }
}

TEST(SharedFriction, FeetShareByTheirLoads) {
  const auto m = contact_motion(block("[0, 0, 0]"), 5);
  EXPECT_NEAR(std::abs(m.last("l1.friction")) + std::abs(m.last("l2.friction")), 5, 1e-12);
  EXPECT_EQ(m.last("l1.mode"), 2);
  EXPECT_EQ(m.last("l2.mode"), 2);
  EXPECT_LT(std::abs(m.last("x'")), 1e-30);
}

// A foot without friction leaves the whole force to the other one, which slips at its own limit.
TEST(SharedFriction, SmoothFootCarriesNothing) {
  std::string text = block("[0, 0, -0.1]");
  text.replace(text.rfind("friction = \"k\""), std::string("friction = \"k\"").size(), "friction = 0");
  const auto m = contact_motion(text, 4);
  ASSERT_EQ(test::times(m, "l1.slips").size(), 1U);
  EXPECT_NEAR(test::times(m, "l1.slips")[0], kLimit / 2, 1e-9);
}

// With a static coefficient the slip begins with a jump of the acceleration.
TEST(SharedFriction, StaticFrictionHoldsLonger) {
  std::string text = block("[0, 0, -0.1]");
  for (std::size_t i = 0; (i = text.find("friction = \"k\"", i)) != std::string::npos; i += 40)
    text.insert(i, "static_friction = 0.4, ");
  const auto m = contact_motion(text, 8);
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  const double begin = 0.4 * 2 * 9.81;
  for (const char* event : {"l1.slips", "l2.slips"}) {
    ASSERT_EQ(test::times(m, event).size(), 1U) << event;
    EXPECT_NEAR(test::times(m, event)[0], begin, 1e-7) << event;
  }
  EXPECT_NEAR(m.last("x'"), (64 - begin * begin) / 4 - kLimit / 2 * (8 - begin), 1e-8);
}

std::string stool(const std::string& force) {
  return R"toml(coordinates = ["x", "y", "z", "a", "b", "c"]
parameters = {m = 2, k = 0.3, h = "sqrt(3)/2"}
gravity.field = "-9.81*ez"
body = [{name = "s", mass = "m", inertia = [0.1, 0.1, 0.1], center = "x*ex + y*ey + z*ez", orientation = "rotz(a)*roty(b)*rotx(c)"}]
contact = [
  {name = "l1", body = "s", shape = "point", at = "s.center + s(0.3, 0, -0.2)", friction = "k"},
  {name = "l2", body = "s", shape = "point", at = "s.center + s(-0.15, 0.3*h, -0.2)", friction = "k"},
  {name = "l3", body = "s", shape = "point", at = "s.center + s(-0.15, -0.3*h, -0.2)", friction = "k"},
]
initial = {z = 0.2}
force = [{)toml" +
         force + "}]\n";
}

TEST(SharedFriction, StoolIsPushedAtItsCentre) {
  const auto m = contact_motion(stool("on = \"s\", vector = \"t*ex\""), 8);
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  EXPECT_NEAR(test::times(m, "l2.slips").at(0), kLimit, 1e-7);
  EXPECT_NEAR(m.last("x"), std::pow(8 - kLimit, 3) / 12, 1e-9);
  EXPECT_LT(std::abs(m.last("a")), 1e-9);
}

// A torque t about the vertical turns the stool against the moment mu m g r of its three feet.
TEST(SharedFriction, StoolIsTurned) {
  const auto m = contact_motion(stool("on = \"s\", torque = \"t*ez\""), 3);
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  const double begin = 0.3 * kLimit;
  EXPECT_NEAR(test::times(m, "l1.slips").at(0), begin, 1e-7);
  EXPECT_NEAR(m.last("a"), std::pow(3 - begin, 3) / 0.6, 1e-8);
}

// Pushed off its centre at the floor, with feet at (0.3, 0) and (-0.15, +-0.26), the stool stands until the limit load
// of the three cones. The reference is the solution of that convex problem by another program (SLSQP of SciPy).
TEST(SharedFriction, StoolPushedOffItsCentreSlipsAtItsLimitLoad) {
  std::string text = stool("on = {body = \"s\", at = [0, 0.15, -0.2]}, vector = \"t*ex\"");
  text.replace(text.find("sqrt(3)/2"), 9, "0.26/0.3");
  const auto m = contact_motion(text, 6);
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  for (const char* event : {"l1.slips", "l2.slips", "l3.slips"})
    EXPECT_NEAR(test::times(m, event).at(0), 4.883257117, 2e-8);
}

std::string axle(const std::string& roll, const std::string& orientation) {
  return R"toml(coordinates = ["x", "y", "z", "psi", )toml" + roll + R"toml("r", "l"]
parameters = {M = 8, R = 0.1, b = 0.2, T = 0.3}
gravity.field = "-9.81*ez"
frame.B = ")toml" +
         orientation + R"toml("
point.A = "x*ex + y*ey + z*ez"
body = [
  {name = "hull", mass = "M", inertia = [0.2, 0.2, 0.2], center = "A", orientation = "B"},
  {name = "right", mass = 0.5, shape = "disc(R)", center = "A - b*B.y", orientation = "B*rotx(-pi/2)*rotz(r)"},
  {name = "left", mass = 0.5, shape = "disc(R)", center = "A + b*B.y", orientation = "B*rotx(-pi/2)*rotz(l)"},
]
contact = [{name = "cr", body = "right", friction = 0.8}, {name = "cl", body = "left", friction = 0.8}]
force = [{generalized = {r = "T*t", l = "T*t"}}]
monitor.slip_r = "x' + b*psi' - R*r'"
monitor.slip_l = "x' - b*psi' - R*l'"
initial = {z = "R"}
)toml";
}

// The loads of four feet are not determined: the least loads are 4.905 each, and the limit load of their cones is the
// same problem with these loads.
TEST(SharedFriction, FourFeetSlipAtTheLimitLoadOfTheirLeastLoads) {
  const auto m = contact_motion(R"toml(coordinates = ["x", "y", "z", "a", "b", "c"]
parameters = {m = 2, k = 0.3}
gravity.field = "-9.81*ez"
body = [{name = "s", mass = "m", shape = "box(0.6, 0.4, 0.2)", center = "x*ex + y*ey + z*ez", orientation = "rotz(a)*roty(b)*rotx(c)"}]
contact = [{name = "f", body = "s", friction = "k"}]
initial = {z = 0.1}
force = [{on = "s", torque = "t*ez"}]
)toml",
                                Rational(5, 2));
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  const double begin = kLimit * std::hypot(0.3, 0.2), inertia = 2 * (0.36 + 0.16) / 12;
  std::size_t feet = 0;
  for (const char* foot : {"f1", "f2", "f3", "f4", "f5", "f6", "f7", "f8"})
    if (const auto times = test::times(m, std::string(foot) + ".slips"); !times.empty()) {
      ++feet;
      EXPECT_NEAR(times[0], begin, 1e-7) << foot;
    }
  EXPECT_EQ(feet, 4U);
  EXPECT_NEAR(m.last("a"), std::pow(2.5 - begin, 3) / 6 / inertia, 1e-8);
}

// Two wheels on one axle share the sideways force, and each rolls: x'' = (2 T/R)/(M + 2 m + 2 I/R^2).
TEST(SharedFriction, DrivenAxleRollsStraight) {
  const auto m = contact_motion(axle("\"roll\", ", "rotz(psi)*rotx(roll)"), 1);
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  EXPECT_NEAR(m.last("x'"), 2 * 0.3 / 0.1 / 2 / (8 + 1 + 0.5), 1e-12);
  for (const char* slip : {"slip_r", "slip_l"}) EXPECT_LT(std::abs(m.last(slip)), 1e-12) << slip;
  for (const char* friction : {"cr.friction", "cl.friction"})
    EXPECT_NEAR(m.last(friction), 27.0 / 9.5, 1e-12) << friction;
}

// Without the coordinate by which the axle tilts, its wheels carry equal loads.
TEST(SharedFriction, LoadsThatNothingDeterminesAreTheLeast) {
  const auto m = contact_motion(axle("", "rotz(psi)"), 1);
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  EXPECT_NEAR(m.last("x'"), 2 * 0.3 / 0.1 / 2 / (8 + 1 + 0.5), 1e-12);
  EXPECT_LT(std::abs(m.last("psi'")), 1e-12);
  for (const char* load : {"cr.normal", "cl.normal"}) EXPECT_NEAR(m.last(load), 4.5 * 9.81, 1e-12) << load;
}

// A contact moves although its mode is sticking, which the equations of a motion do not show.
TEST(SharedFriction, ContactsThatDoNotAsTheirModesSayAreFound) {
  const SourceText source{"test.toml", block("[0, 0, 0]")};
  Diagnostics diagnostics;
  const auto open = open_model(source, diagnostics, {});
  ASSERT_TRUE(open) << diagnostics.print(source);
  Scenario s;
  ASSERT_TRUE(make_scenario(open->model, *find_formulation("routh"), {}, s).ok());
  Workspace own(s);
  std::vector<Contact> list = contacts(*open->names);
  const auto says = [&](double velocity, Touch touch, double direction) {
    TouchingBodies bodies(own, list, {Rational(0), {0, 0.1, 0}, {velocity, 0, 0}, {}});
    bodies.modes.resize(2);
    for (ContactMode& m : bodies.modes) m.touch = touch, m.direction = {direction, 0};
    bodies.look();
    return bodies.contradiction().value_or("");
  };
  EXPECT_EQ(says(0, Touch::sticks, 0), "");
  EXPECT_EQ(says(1, Touch::slips, 1), "");
  EXPECT_EQ(says(1, Touch::sticks, 0), "the contact 'l1' sticks, and slips with 1");
  EXPECT_EQ(says(1, Touch::slips, -1), "the contact 'l1' slips against its direction with 1");
  for (Contact& c : list) c.units.slip = "m/s";
  EXPECT_EQ(says(1, Touch::sticks, 0), "the contact 'l1' sticks, and slips with 1 m/s");
}

// The force of a table touches the limit of the two feet at the knot t = 1 and falls again.
TEST(SharedForces, NoFootSlipsWhereAForceTouchesTheLimit) {
  std::string text = block("\"s.center\"") + "table = [{name = \"P\", x = [0, 1, 2, 3], y = [0, 1, 0, 3]}]\n";
  text.replace(text.find("\"t*ex\""), 6, "\"" + std::to_string(kLimit) + "*P(t)*ex\"");
  const auto m = contact_motion(text, 3);
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  for (const std::string foot : {"l1.slips", "l2.slips"}) {
    ASSERT_EQ(test::times(m, foot).size(), 1U);
    EXPECT_NEAR(test::times(m, foot)[0], 7.0 / 3, 1e-9);
  }
  EXPECT_NEAR(m.last("x'"), kLimit / 2 / 2 * 3 * 4.0 / 9, 1e-9);
}

// The corners of a box on a slowly tilting plate slip together at tan(w t) = mu; the error of this time is that of
// 1e-12 of the forces.
TEST(SharedForces, BoxOnATiltingPlateSlipsAtTheAngleOfFriction) {
  const auto m = test::contact_motion(R"toml(coordinates = ["x", "z", "p"]
parameters = {m = 2, a = 0.2, h = 0.3, g = 9.81, mu = 0.5, w = 0.1}
gravity.field = "g*(sin(w*t)*ex - cos(w*t)*ez)"
body = [{name = "box", mass = "m", shape = "box(a, a, h)", center = "x*ex + z*ez", orientation = "roty(p)"}]
contact = [{name = "c", body = "box", friction = "mu"}]
initial = {z = "h/2"}
)toml",
                                      5);
  for (const char* name : {"c1.slips", "c2.slips"}) {
    ASSERT_EQ(test::times(m, name).size(), 1U) << name;
    EXPECT_NEAR(test::times(m, name)[0], 10 * std::atan(0.5), 1e-11);
  }
}

}  // namespace shared_forces_test
}  // namespace anholon
