// Vehicles without roll and pitch, on a plane that tilts: their wheels begin to slip one after the other.
#include <cmath>

#include <gtest/gtest.h>

#include "contact/law/consistent_modes.h"
#include "support/contact_motion.h"

namespace anholon {
namespace vehicles_test {

using test::contact_motion;

struct Wheel {
  const char *name, *place;
};

std::string vehicle(const std::string& mass, const std::string& inertia, const std::string& tilt,
                    const std::string& friction, const std::vector<Wheel>& wheels, const std::string& torques) {
  std::string text = R"toml(parameters = {M = )toml" + mass + R"toml(, R = 0.1}
gravity.field = ")toml" +
                     tilt + R"toml("
frame.B = "rotz(psi)"
point.A = "x*ex + y*ey + z*ez"
initial = {z = "R"}
constraint = [{name = "locked", equation = "w0' = 0"}]
)toml";
  std::string coordinates = "\"x\", \"y\", \"z\", \"psi\"",
              body = "{name = \"hull\", mass = \"M\", inertia = [0.3, 0.3, " + inertia +
                     "], center = \"A + 0.05*B.z\", orientation = \"B\"},\n",
              contact;
  for (const Wheel& w : wheels) {
    const std::string n = w.name;
    coordinates += ", \"w" + n + "\"";
    body += "{name = \"b" + n + "\", mass = 0.5, shape = \"disc(R)\", center = \"A + " + w.place +
            "\", orientation = \"B*rotx(-pi/2)*rotz(w" + n + ")\"},\n";
    contact += "{name = \"c" + n + "\", body = \"b" + n + "\", friction = " + friction + "}, ";
  }
  return "coordinates = [" + coordinates + "]\n" + text + "body = [" + body + "]\ncontact = [" + contact +
         "]\nforce = [{generalized = {" + torques + "}}]\n";
}

// The rear wheels of a tricycle begin to slip while the front one slips already and the body turns. Regularized friction
// -mu N v/sqrt(v^2 + eps^2) by SciPy's Radau tends to the values for small eps: x(1.5) is -1.10130717, -1.10122468,
// -1.10121174 for eps = 1e-5, 1e-6, 1e-7.
TEST(Vehicles, RearWheelsOfATricycleBeginToSlipBesideItsFrontWheel) {
  const auto m = contact_motion(
      vehicle("6.65", "0.326", "-9.81*cos(0.63*t)*ez + 9.81*sin(0.63*t)*(cos(2.57)*ex + sin(2.57)*ey)", "0.5",
              {{"0", "0.3*B.x"}, {"1", "(-0.3)*B.x - 0.2*B.y"}, {"2", "(-0.3)*B.x + 0.2*B.y"}}, "w1 = 0.29"),
      Rational(3, 2));
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  for (const char* event : {"c0.slips", "c1.slips", "c2.slips"}) EXPECT_EQ(test::times(m, event).size(), 1U) << event;
  EXPECT_NEAR(m.last("x"), -1.10121030, 3e-6);
  EXPECT_NEAR(m.last("y"), 0.32796430, 3e-6);
  EXPECT_NEAR(m.last("psi"), 1.88449546, 3e-6);
  EXPECT_NEAR(m.last("psi'"), 4.52822012, 3e-6);
}

// A wheel that is locked and one that rolls come to their limits together, and the others hold. The slip begins with
// accelerations of 1e-9 of those without friction. The motion does not depend on the rows that are asked for, also where one
// lies in the time for which wheels are held.
TEST(Vehicles, TwoWheelsOfACartBeginToSlipAndTwoHold) {
  const std::string cart =
      vehicle("9.46", "0.488", "-9.81*cos(0.74*t)*ez + 9.81*sin(0.74*t)*(cos(5.58)*ex + sin(5.58)*ey)", "0.25",
              {{"0", "0.3*B.x - 0.2*B.y"},
               {"1", "0.3*B.x + 0.2*B.y"},
               {"2", "(-0.3)*B.x - 0.2*B.y"},
               {"3", "(-0.3)*B.x + 0.2*B.y"}},
              "w1 = -0.03, w2 = -0.22");
  const auto m = contact_motion(cart, Rational(17, 100)),
             rows = contact_motion(cart, Rational(17, 100), {}, {Rational(15, 100), Rational(17, 100)});
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  for (const char* event : {"c0.slips", "c1.slips"}) {
    ASSERT_EQ(test::times(m, event).size(), 1U) << event;
    EXPECT_NEAR(test::times(m, event)[0], 0.14974804, 1e-8) << event;
  }
  EXPECT_EQ(m.last("c2.mode"), 2);
  EXPECT_EQ(m.last("c3.mode"), 2);
  EXPECT_EQ(m.report.steps, rows.report.steps);
  for (const char* q : {"x", "y", "psi", "w0", "w1"}) EXPECT_EQ(m.last(q), rows.last(q)) << q;
}

}  // namespace vehicles_test
}  // namespace anholon
