// An impact is the same for all observers: bodies strike a moving surface as they strike a surface at rest, with the
// velocities relative to it. The same impacts are refused because they would raise the energy, which relative
// velocities decide. The mutant is the energy in the frame of the observer: a belt raises it in valid impacts.
#include <cmath>

#include <gtest/gtest.h>

#include "support/contact_motion.h"

namespace anholon::impact_observer_test {
namespace {

using test::contact_motion;

// A rod of mass 1 and half length 1 whose tip strikes, at once, a surface with the velocity (V, U).
std::string rod(const std::string& law) {
  return R"toml(coordinates = ["x", "z", "phi"]
parameters = {V = 0, U = 0, mu = 0, e = 0, angle = 0, slip = 0}
point.C = "x*ex + z*ez"
frame.B = "roty(phi)"
[[body]]
name = "rod"
mass = 1
inertia = ["1/3", "1/3", "1/3"]
center = "C"
orientation = "B"
[[contact]]
name = "tip"
gap = "(C + B.x).z - U*t"
slip = "vel(rod, C + B.x).x - V"
friction = "mu"
restitution = "e"
impact = ")toml" +
         law + R"toml("
[monitor]
gap_rate = "vel(rod, C + B.x).z - U"
slip = "vel(rod, C + B.x).x - V"
energy = "(x'^2 + z'^2)/2 + phi'^2/6"
[initial]
conditions = ["(C + B.x).z = 0", "vel(rod, C + B.x).x = slip + V", "vel(rod, C + B.x).z = U - 1"]
phi = "angle"
"phi'" = 0
)toml";
}

struct After {
  bool refused = false;
  double gap_rate = 0, slip = 0, energy = 0;
};

After strike(const std::string& law, Overrides o, const char* V, const char* U) {
  o["V"] = V, o["U"] = U;
  const auto m = contact_motion(rod(law), Rational(1, 1000), o);
  if (m.report.outcome.ok()) return {false, m.number(0, "gap_rate"), m.number(0, "slip"), m.number(0, "energy")};
  EXPECT_NE(m.report.outcome.message.find("would raise the energy"), std::string::npos) << m.report.outcome.message;
  return {true};
}

TEST(ImpactObserver, SurfacesThatMoveStrikeAsThoseAtRest) {
  std::size_t given = 0, refused = 0;
  for (const char* law : {"newton", "poisson"})
    for (const char* angle : {"-0.8", "0.2", "1.2"})
      for (const char* slip : {"-2", "0.3"})
        for (const char* mu : {"0.3", "1"})
          for (const char* e : {"0", "1"}) {
            Overrides o;
            o = {{"angle", angle}, {"slip", slip}, {"mu", mu}, {"e", e}};
            const After rest = strike(law, o, "0", "0");
            refused += rest.refused;
            for (const auto& [V, U] :
                 {std::pair("20", "0"), std::pair("-7", "0"), std::pair("20", "3"), std::pair("0", "-3")}) {
              const After moved = strike(law, o, V, U);
              ASSERT_EQ(moved.refused, rest.refused) << law << " " << angle << " " << slip << " " << mu << " " << e;
              if (rest.refused) continue;
              EXPECT_NEAR(moved.gap_rate, rest.gap_rate, 1e-13);
              EXPECT_NEAR(moved.slip, rest.slip, 1e-13);
              // Without spin the body moves with the velocity of its tip.
              const double v = std::atof(slip) + std::atof(V), w = std::atof(U) - 1;
              given += moved.energy > (v * v + w * w) / 2 * (1 + 1e-12);
            }
          }
  EXPECT_GT(refused, 0U);
  EXPECT_GT(given, 0U);
}

// A particle falls on a belt that drags it along: mu times the impulse of the floor is less than the belt's velocity.
TEST(ImpactObserver, ABeltGivesEnergy) {
  const auto m = contact_motion(R"toml(coordinates = ["x", "z"]
gravity.field = "-9.81*ez"
particle = [{name = "P", mass = 1, position = "x*ex + z*ez"}]
contact = [{name = "belt", gap = "z", slip = "x' - 20", friction = 2}]
initial = {z = 1}
)toml",
                                Rational(1, 2));
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  const double t = std::sqrt(2 / 9.81);
  EXPECT_NEAR(m.last("x'"), 2 * 9.81 * 0.5, 1e-13);  // as if its weight had pressed it on the belt from the start
  EXPECT_NEAR(times(m, "belt.hits").at(0), t, 1e-15);
}

}  // namespace
}  // namespace anholon::impact_observer_test
