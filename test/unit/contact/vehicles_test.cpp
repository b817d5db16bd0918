// Vehicles without roll and pitch on a tilting plane: their wheels begin to slip, one after the other or together, and
// come to rest again.
//
// The references are motions with regularized friction -mu N v/sqrt(v^2 + eps^2), computed by SciPy's Radau from
// separate equations, with eps = 2e-8; for smaller eps they change by about 1e-6.
#include <cmath>

#include <gtest/gtest.h>

#include "support/contact_motion.h"

namespace anholon {
namespace vehicles_test {

using test::contact_motion;

struct Vehicle {
  const char* name;
  std::vector<const char*> wheels;  // places relative to the middle of the body
  double mass, inertia, offset;     // of the body; its mass centre in front of the middle
  double rate, towards;             // of the tilt
  double friction;
  std::string torques;
  std::vector<int> locked;  // wheels
  double speed;             // at the start
  std::vector<std::string> events;
  double x, y, psi;  // at t = 1.5
};

std::string number(double x) { return std::to_string(x); }

std::string model(const Vehicle& v) {
  std::string coordinates = "\"x\", \"y\", \"z\", \"psi\"", contact, constraint,
              body = "{name = \"hull\", mass = " + number(v.mass) + ", inertia = [0.3, 0.3, " + number(v.inertia) +
                     "], center = \"A + (" + number(v.offset) + ")*B.x + 0.05*B.z\", orientation = \"B\"}, ",
              initial = "z = 0.1, \"x'\" = " + number(v.speed);
  for (std::size_t k = 0; k < v.wheels.size(); ++k) {
    const std::string n = std::to_string(k);
    coordinates += ", \"w" + n + "\"";
    body += "{name = \"b" + n + "\", mass = 0.5, shape = \"disc(0.1)\", center = \"A + " + v.wheels[k] +
            "\", orientation = \"B*rotx(-pi/2)*rotz(w" + n + ")\"}, ";
    contact += "{name = \"c" + n + "\", body = \"b" + n + "\", friction = " + number(v.friction) + "}, ";
    if (v.speed > 0) initial += ", \"w" + n + "'\" = " + number(10 * v.speed);
  }
  for (const int k : v.locked)
    constraint += "{name = \"lock" + std::to_string(k) + "\", equation = \"w" + std::to_string(k) + "' = 0\"}, ";
  return "coordinates = [" + coordinates + "]\ngravity.field = \"-9.81*cos(" + number(v.rate) + "*t)*ez + 9.81*sin(" +
         number(v.rate) + "*t)*(cos(" + number(v.towards) + ")*ex + sin(" + number(v.towards) +
         ")*ey)\"\nframe.B = \"rotz(psi)\"\npoint.A = \"x*ex + y*ey + z*ez\"\nbody = [" + body + "]\ncontact = [" +
         contact + "]\n" + (v.torques.empty() ? "" : "force = [{generalized = {" + v.torques + "}}]\n") +
         (constraint.empty() ? "" : "constraint = [" + constraint + "]\n") + "initial = {" + initial + "}\n";
}

const std::vector<const char*> kBicycle = {"0.3*B.x", "(-0.3)*B.x"},
                               kTricycle = {"0.3*B.x", "(-0.3)*B.x - 0.2*B.y", "(-0.3)*B.x + 0.2*B.y"},
                               kCart = {"0.3*B.x - 0.2*B.y", "0.3*B.x + 0.2*B.y", "(-0.3)*B.x - 0.2*B.y",
                                        "(-0.3)*B.x + 0.2*B.y"};

// The rear wheels begin to slip while the front wheel slips already and the body turns.
const Vehicle kTurning{"turning",   kTricycle,  6.65,        .326, 0, .63,
                       2.57,        .5,         "w1 = 0.29", {0},  0, {"c0.slips", "c1.slips", "c2.slips"},
                       -1.10120998, 0.32796414, 1.88449522};
// A locked and a rolling wheel reach their limits together, and the others hold: the slip begins with 1e-9 of the
// accelerations without friction.
const Vehicle kTogether{"together", kCart,       9.46,
                        .488,       0,           .74,
                        5.58,       .25,         "w1 = -0.03, w2 = -0.22",
                        {0},        0,           {"c0.slips", "c1.slips"},
                        2.12654258, -1.23879703, -0.60861347};
// The rear wheel slips slowly for 0.2 s.
const Vehicle kSlow{"slow",    kBicycle,    9.78,         .487, -.06, .65,
                    4.98,      .26,         "w1 = -0.38", {},   0,    {"c1.slips", "c0.slips"},
                    0.2638563, -1.45177604, 1.35359508};
// The body turns by more than a right angle, so the sides of the wheels lie along the other axis.
const Vehicle kTurned{
    "turned", kTricycle, 11.55,        .225,        .066,       .67,       1.9, .77, "w0 = 0.06, w1 = 0.3, w2 = -0.2",
    {},       .2,        {"c0.slips"}, -0.40701665, 0.60863715, 1.65925211};
// The cart slides along its wheels, one of which is locked: its other velocities are round-off and count as no slip.
const Vehicle kStraight{"straight",
                        kCart,
                        9.61,
                        .313,
                        0,
                        .48,
                        5.89,
                        .49,
                        "w0 = 0.55, w2 = 0.38, w3 = -0.44",
                        {1},
                        0,
                        {"c1.slips"},
                        1.56353153,
                        -0.00135160793,
                        0.00870933113};
// The slips of both rear wheels end at once.
const Vehicle kEnding{"ending",   kTricycle,  8.46,
                      .319,       0,          .75,
                      1.03,       .28,        "w0 = -0.52, w1 = -0.24",
                      {},         0,          {"c0.slips", "c1.slips", "c1.sticks"},
                      1.21219415, 1.68927561, 0.99256844};

// A wheel that is locked comes to its limit while its side force could still leave it some of it.
const Vehicle kSideForce{"side_force", kTricycle,  8.9,         0.109, 0, 0.35,
                         0.91,         .34,        "w0 = 0.04", {2},   0, {"c2.slips", "c0.slips"},
                         0.38047539,   0.29043115, 0.52085993};

class Vehicles : public testing::TestWithParam<Vehicle> {};

TEST_P(Vehicles, MoveAsWithRegularizedFriction) {
  const Vehicle& v = GetParam();
  const auto m = contact_motion(model(v), Rational(3, 2));
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  for (const std::string& event : v.events) EXPECT_GE(test::times(m, event).size(), 1U) << event;
  EXPECT_NEAR(m.last("x"), v.x, 5e-6);
  EXPECT_NEAR(m.last("y"), v.y, 5e-6);
  EXPECT_NEAR(m.last("psi"), v.psi, 5e-6);
}

INSTANTIATE_TEST_SUITE_P(OnASlope, Vehicles,
                         testing::Values(kTurning, kTogether, kSlow, kTurned, kStraight, kEnding, kSideForce),
                         [](const auto& test) { return std::string(test.param.name); });

// The motion does not depend on the requested rows, even on a row in the time for which wheels are held.
TEST(VehicleRows, LeaveTheMotion) {
  const auto m = contact_motion(model(kTogether), Rational(17, 100)),
             rows = contact_motion(model(kTogether), Rational(17, 100), {}, {Rational(15, 100), Rational(17, 100)});
  ASSERT_EQ(test::times(m, "c0.slips").size(), 1U);
  EXPECT_NEAR(test::times(m, "c0.slips")[0], 0.14974804, 1e-8);
  for (const char* q : {"x", "y", "psi", "w0", "w1"}) EXPECT_NEAR(m.last(q), rows.last(q), 1e-13) << q;
}

// Taylor's steps would be 3e-10 long at the beginning of the slip.
TEST(SlowSlips, AreFollowedByBdf) {
  const auto m = contact_motion(model(kSlow), Rational(2, 5));
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  EXPECT_LT(m.report.steps, 3000U);
  ASSERT_EQ(m.report.method.turns.size(), 1U);
  EXPECT_EQ(m.report.method.turns[0].to, Method::bdf);
  EXPECT_GT(m.report.method.steps, 50U);
}

// With a loose tolerance Taylor's method alone takes 92 000 steps.
TEST(SlowSlips, AreFollowedByBdfWithALooseTolerance) {
  const auto m = contact_motion(model(kSlow), Rational(2, 5), {}, {}, Rational(1, 1'000'000));
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  EXPECT_LT(m.report.steps, 10000U);
  EXPECT_GT(m.report.method.steps, 10U);
}

// At rest all velocities are round-off, also the velocity of a slipping contact.
TEST(LockedVehicles, Rest) {
  const Vehicle locked{"locked", kTricycle, 9.51, .396, -.058, .23, 1.48, .78, "", {0, 1, 2}, 0, {}, 0, 0, 0};
  const auto m = contact_motion(model(locked), Rational(3, 2));
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  EXPECT_LT(std::abs(m.last("x")), 1e-25);
}

}  // namespace vehicles_test
}  // namespace anholon
