// Impacts by Poisson's and by Newton's law: some agree, some differ, and Poisson's law never raises the energy.
#include <cmath>

#include <gtest/gtest.h>

#include "support/contact_motion.h"

namespace anholon {
namespace impact_laws_test {

using test::contact_motion;

// A rod of mass 1 and half length 1 without gravity, whose tip strikes the floor at once.
struct Strike {
  double angle, gap_rate, slip, friction, restitution;
};

std::string rod(const Strike& s, const std::string& law) {
  const auto number = [](double x) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", x);
    return std::string(text);
  };
  return R"toml(coordinates = ["x", "z", "phi"]
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
gap = "(C + B.x).z"
slip = "vel(rod, C + B.x).x"
friction = )toml" +
         number(s.friction) + "\nrestitution = " + number(s.restitution) + "\nimpact = \"" + law + "\"\n" +
         R"toml([monitor]
gap_rate = "vel(rod, C + B.x).z"
slip = "vel(rod, C + B.x).x"
energy = "x'^2/2 + z'^2/2 + phi'^2/6"
[initial]
conditions = ["(C + B.x).z = 0", "vel(rod, C + B.x).x = )toml" +
         number(s.slip) + "\", \"vel(rod, C + B.x).z = " + number(s.gap_rate) + "\"]\nphi = " + number(s.angle) +
         "\n\"phi'\" = 0\n";
}

struct After {
  double gap_rate, slip;
};

// Computes the impact by Routh's method: the impulse N of the floor grows, friction mu N opposes the slip until the
// slip ends, and then holds. No system of equations is solved. The friction must suffice to hold.
After by_routh(const Strike& s) {
  const double c = std::cos(s.angle), d = std::sin(s.angle);
  const double nn = 1 + 3 * c * c, tt = 1 + 3 * d * d, nt = 3 * c * d;  // velocities of the tip by unit impulses
  EXPECT_LT(std::abs(nt / tt), s.friction);
  const double against = s.slip > 0 ? -s.friction : s.friction;
  const double ends = -s.slip / (nt + against * tt);  // the impulse at which the slip ends
  const double gap_rate = s.gap_rate + ends * (nn + against * nt);
  EXPECT_LT(gap_rate, 0);  // the slip ends within the compression
  const double held = nn - nt * nt / tt;
  const double compression = ends - gap_rate / held;
  return {held * s.restitution * compression, 0};
}

After strike(const Strike& s, const std::string& law) {
  const auto m = contact_motion(rod(s, law), Rational(1, 1000));
  EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  return {m.number(0, "gap_rate"), m.number(0, "slip")};
}

TEST(ImpactLaws, ObliqueRodWithFrictionFollowsPoisson) {
  for (const Strike s :
       {Strike{0.9, -2, 0.5, 1.2, 0.6}, Strike{1.2, -1, -0.3, 0.9, 0.8}, Strike{-0.7, -3, 0.4, 2, 0.5}}) {
    const After law = by_routh(s), is = strike(s, "poisson");
    EXPECT_NEAR(is.gap_rate, law.gap_rate, 1e-14);
    EXPECT_NEAR(is.slip, 0, 1e-14);
    // The mutant: Newton's law gives another velocity.
    const After newton = strike(s, "newton");
    EXPECT_NEAR(newton.gap_rate, -s.restitution * s.gap_rate, 1e-14);
    EXPECT_GT(std::abs(newton.gap_rate - law.gap_rate), 1e-2);
  }
}

TEST(ImpactLaws, TheyAgreeWithoutFrictionAndInASteadySlip) {
  for (const Strike s : {Strike{0.9, -2, 0.5, 0, 0.6}, Strike{0.4, -1, 9, 0.2, 0.7}, Strike{1.1, -1, -9, 0.2, 0.7}}) {
    const After a = strike(s, "newton"), b = strike(s, "poisson");
    EXPECT_NEAR(a.gap_rate, b.gap_rate, 1e-14);
    EXPECT_NEAR(a.slip, b.slip, 1e-14);
  }
  const auto ball = [](const std::string& law) {
    return contact_motion("coordinates = [\"x\"]\nparticle = [{name = \"ball\", mass = 1, position = \"x*ex\"}]\n"
                          "gravity.field = \"-10*ex\"\ninitial = {x = 5}\n"
                          "contact = [{name = \"floor\", gap = \"x\", restitution = 0.5, impact = \"" +
                              law + "\"}]\n",
                          4);
  };
  const auto newton = ball("newton"), poisson = ball("poisson");
  ASSERT_EQ(newton.report.events.size(), poisson.report.events.size());
  for (std::size_t k = 0; k < newton.report.events.size(); ++k)
    EXPECT_NEAR(newton.report.events[k].t.value, poisson.report.events[k].t.value, 1e-13);
}

// Over a grid of angles, slips and frictions: Newton's law raises the energy in some cases, which it refuses, and
// Poisson's in none.
TEST(ImpactLaws, PoissonNeverRaisesTheEnergy) {
  std::size_t newton_raises = 0, cases = 0;
  for (const double angle : {-1.3, -0.8, -0.3, 0.2, 0.6, 1.0, 1.4})
    for (const double slip : {-2.0, -0.4, -0.05, 0.05, 0.4, 2.0})
      for (const double friction : {0.1, 0.5, 1.0})
        for (const double restitution : {0.3, 1.0}) {
          const Strike s{angle, -1, slip, friction, restitution};
          const auto newton = contact_motion(rod(s, "newton"), Rational(1, 1000));
          newton_raises += newton.report.outcome.message.find("raise the energy") != std::string::npos;
          const auto poisson = contact_motion(rod(s, "poisson"), Rational(1, 1000));
          ASSERT_TRUE(poisson.report.outcome.ok()) << angle << " " << slip << ": " << poisson.report.outcome.message;
          // Without spin the body moves with the velocity of its tip.
          const double before = (slip * slip + 1) / 2;
          EXPECT_LE(poisson.number(0, "energy"), before * (1 + 1e-14)) << angle << " " << slip;
          EXPECT_GE(poisson.number(0, "gap_rate"), 0);
          ++cases;
        }
  EXPECT_EQ(cases, 252U);
  EXPECT_GT(newton_raises, 0U);
}

// Three balls touch, and the first strikes the others: the laws agree.
TEST(ImpactLaws, SeveralContactsAtOneTime) {
  for (const char* law : {"newton", "poisson"}) {
    std::string text = R"toml(coordinates = ["a", "b", "c"]
particle = [{name = "A", mass = 1, position = "a*ex"}, {name = "B", mass = 1, position = "(b + 1)*ex"}, {name = "C", mass = 1, position = "(c + 2)*ex"}]
initial = {"a'" = 1}
contact = [{name = "first", gap = "b - a", restitution = 0.5, impact = "LAW"}, {name = "second", gap = "c - b", restitution = 0.5, impact = "LAW"}]
)toml";
    for (std::size_t k = text.find("LAW"); k != std::string::npos; k = text.find("LAW")) text.replace(k, 3, law);
    const auto m = contact_motion(text, 1);
    ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    EXPECT_NEAR(m.last("a'") + m.last("b'") + m.last("c'"), 1, 1e-15);
    // The compression has the impulses 2/3 and 1/3 and gives all balls the velocity 1/3; the expansion adds half of
    // these impulses.
    EXPECT_NEAR(m.last("a'"), 0, 1e-15);
    EXPECT_NEAR(m.last("b'"), 0.5, 1e-15);
    EXPECT_NEAR(m.last("c'"), 0.5, 1e-15);
  }
}

TEST(ImpactLaws, ContactsOfAModelHaveOneLaw) {
  const auto refused = [](const std::string& second) {
    try {
      contact_motion("coordinates = [\"x\"]\nparticle = [{name = \"ball\", mass = 1, position = \"x*ex\"}]\n"
                     "contact = [{name = \"a\", gap = \"x\", impact = \"poisson\"}, {name = \"b\", gap = \"9 - x\"" +
                         second + "}]\n",
                     1);
    } catch (const std::runtime_error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_NE(refused("").find("have different laws of impacts"), std::string::npos) << refused("");
  EXPECT_NE(refused(", impact = \"stronge\"").find("newton"), std::string::npos) << refused(", impact = \"stronge\"");
  EXPECT_EQ(refused(", impact = \"poisson\""), "");
}

}  // namespace impact_laws_test
}  // namespace anholon
