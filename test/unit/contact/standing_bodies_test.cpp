// A body that rests on inclined surfaces stands as long as forces within the cones of friction hold it, whichever the
// distribution without friction is.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "support/contact_motion.h"

namespace anholon {
namespace standing_bodies_test {

using test::contact_motion;

constexpr double kWeight = 2 * 9.81;

// A point of the body, the angle of the normal to the vertical there, and the coefficients of friction.
struct Point {
  double x, z, angle, sticks, slips;
};
// The load that grows with the time.
struct Load {
  double x, z, torque;
};
using Wrench = std::array<double, 3>;

std::string text_of(double x) {
  std::ostringstream out;
  out.precision(17);
  out << x;
  return out.str();
}

std::string body(const std::vector<Point>& points, const Load& load) {
  std::string text = R"toml(coordinates = ["x", "z", "p"]
gravity.field = "-9.81*ez"
body = [{name = "b", mass = 2, inertia = [0.1, 0.1, 0.1], center = "x*ex + z*ez", orientation = "roty(p)"}]
contact = [
)toml";
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Point& p = points[k];
    const std::string x = text_of(p.x), z = text_of(p.z), a = text_of(p.angle);
    text += "{name = \"c" + std::to_string(k) + "\", body = \"b\", at = \"b.center + b(" + x + ", 0, " + z +
            ")\", normal = \"sin(" + a + ")*ex + cos(" + a + ")*ez\", through = \"(" + x + ")*ex + (" + z +
            ")*ez\", friction = " + text_of(p.slips) + ", static_friction = " + text_of(p.sticks) + "},\n";
  }
  return text + "]\nforce = [{on = \"b\", vector = \"t*((" + text_of(load.x) + ")*ex + (" + text_of(load.z) +
         ")*ez)\"}, {on = \"b\", torque = \"t*(" + text_of(load.torque) + ")*ey\"}]\n";
}

double determinant(const Wrench& a, const Wrench& b, const Wrench& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1]) + c[0] * (a[1] * b[2] - a[2] * b[1]);
}

// The largest t with which forces along the edges of the cones balance the weight and the load. It is taken with two
// forces that are not zero, as at each vertex of a linear program with three equations.
double limit(const std::vector<Point>& points, const Load& load) {
  std::vector<Wrench> edges;
  for (const Point& p : points)
    for (const double sign : {1, -1}) {
      const double x = std::sin(p.angle) + sign * p.sticks * std::cos(p.angle),
                   z = std::cos(p.angle) - sign * p.sticks * std::sin(p.angle);
      edges.push_back({x, z, p.z * x - p.x * z});
    }
  const Wrench weight{0, kWeight, 0}, grows{load.x, load.z, load.torque};
  double most = 0;
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double all = determinant(edges[i], edges[j], grows);
      if (determinant(weight, edges[j], grows) / all < 0 || determinant(edges[i], weight, grows) / all < 0) continue;
      most = std::max(most, determinant(edges[i], edges[j], weight) / all);
    }
  return most;
}

struct Case {
  std::vector<Point> points;
  Load load;
  double limit;  // by linear programming
};

// The body stands until shortly before the limit. Contacts may leave that friction does not need to press.
void stands(const Case& c) {
  EXPECT_NEAR(limit(c.points, c.load), c.limit, 1e-6 * c.limit);
  const auto m = contact_motion(body(c.points, c.load), Rational(limit(c.points, c.load) * (1 - 1e-7)));
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  for (const EventReport& e : m.report.events)
    EXPECT_TRUE(e.name.ends_with(".leaves")) << e.name << " at " << e.t.value;
  for (const char* q : {"x", "z", "p"}) EXPECT_LT(std::abs(m.last(q)), 1e-12) << q;
  for (std::size_t k = 0; k < c.points.size(); ++k) {
    const std::string name = "c" + std::to_string(k);
    const double N = m.last(name + ".normal");
    EXPECT_GT(N, -1e-9 * kWeight);
    EXPECT_LT(std::abs(m.last(name + ".friction")), c.points[k].sticks * N + 1e-9 * kWeight);
  }
}

TEST(StandingBody, StandsUpToItsLimitOnTwoSurfaces) {
  stands(
      {{{-0.295, -0.825, 0.518, 0.75, 0.75}, {0.284, -0.457, -0.774, 0.47, 0.47}}, {0.547, -0.227, 0.441}, 13.496922});
  stands({{{-0.431, -0.787, 0.35026862336236775, 0.75, 0.75}, {0.251, -0.291, -0.4536873158493885, 0.58, 0.58}},
          {0.677, -0.885, 0.315},
          20.872832});
}

// Without friction a contact pulls, or is opened by the load. With friction it holds the body.
TEST(StandingBody, StandsUpToItsLimitOnThreeSurfaces) {
  stands(
      {{{-0.444, -0.495, 0.425, 0.41, 0.41}, {-0.401, -0.633, -0.875, 0.72, 0.72}, {0.911, -0.875, -0.273, 0.43, 0.43}},
       {0.359, 0.164, -0.423},
       38.375811});
  stands({{{-0.9, -0.144, 1.0007216805998451, 0.36, 0.36},
           {-0.341, -0.521, 0.6908421690496707, 0.75, 0.75},
           {0.752, -0.293, -1.216283637703796, 0.75, 0.75}},
          {-0.855, 0.925, -0.156},
          26.300224});
  stands({{{-0.989, -0.261, 1.0327558825208965, 0.34, 0.34},
           {-0.4, -0.283, 0.7167827946375034, 0.32, 0.32},
           {0.747, -0.579, -0.7144613060244612, 0.3, 0.3}},
          {-0.11, 0.009, 0.053},
          145.51272});
  stands({{{0.216, -0.651, 0.06727911634226924, 0.69, 0.69},
           {0.31, -0.118, 0.7988719533826603, 0.9, 0.9},
           {0.408, -0.538, 0.7341605641693858, 0.33, 0.33}},
          {-0.16, -0.141, -0.329},
          5.3349639});
  stands({{{-0.625, -0.94, -0.20566288667704202, 0.43, 0.43},
           {-0.221, -0.539, -1.0317239178191169, 0.78, 0.78},
           {0.83, -0.399, -0.3404163917694103, 0.52, 0.52}},
          {0.595, 0.13, 0.091},
          37.20049});
}

// If the friction of sliding is smaller, the body could also begin to slip before the limit. It does not as long as it
// can stand.
TEST(StandingBody, GoesOnStandingIfItCouldSlipAsWell) {
  stands(
      {{{-0.675, -0.788, 0.374, 0.43, 0.301}, {0.958, -0.56, -1.228, 0.22, 0.154}}, {-0.052, 0.921, 0.055}, 12.822315});
  stands({{{-0.228, -0.822, -0.5034834742836242, 0.63, 0.441}, {0.434, -0.516, -0.7795441368480439, 0.8, 0.56}},
          {0.576, 0.799, -0.488},
          18.421349});
}

// At the limit the body begins to roll over one contact, and the other one leaves.
TEST(StandingBody, RollsAtItsLimit) {
  const std::vector<Point> points = {{0.21, -0.511, 0.9192082444960372, 0.21, 0.21},
                                     {0.641, -0.707, -1.0266633271981693, 0.77, 0.77}};
  const Load load{-0.572, 0.678, 0.262};
  const auto m = contact_motion(body(points, load), Rational(176, 10));
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  ASSERT_EQ(m.report.events.size(), 1U);
  EXPECT_EQ(m.report.events[0].name, "c1.leaves");
  EXPECT_NEAR(m.report.events[0].t.value, limit(points, load), 1e-8);
}

// The body stands with forces far inside of the cones, but may also roll over one of its contacts.
TEST(StandingBody, ThatMayAlsoRollIsUndecided) {
  const auto m = contact_motion(
      body({{-0.5, -0.5, -std::atan2(0.8, 0.6), 3, 3}, {-0.1, -0.7, std::atan2(0.28, 0.96), 3, 3}}, {0, 0, 0}), 1);
  EXPECT_FALSE(m.report.outcome.ok());
  EXPECT_NE(m.report.outcome.message.find("Painlev"), std::string::npos) << m.report.outcome.message;
}

// Blocks that nothing joins, each on two feet, slip at their own limits; the number of modes of all of them together
// grows as a power.
TEST(StandingBody, BlocksThatNothingJoinsAreTriedByThemselves) {
  constexpr int kBlocks = 4;
  std::string coordinates, bodies, contacts, forces, initial;
  for (int k = 0; k < kBlocks; ++k) {
    const std::string n = std::to_string(k), friction = text_of(0.2 + 0.05 * k), sticks = text_of(0.3 + 0.05 * k);
    coordinates += "\"x" + n + "\", \"z" + n + "\", \"p" + n + "\", ";
    bodies += "{name = \"b" + n + "\", mass = 2, inertia = [0.1, 0.1, 0.1], center = \"x" + n + "*ex + z" + n +
              "*ez\", orientation = \"roty(p" + n + ")\"},\n";
    for (const char* side : {"-0.3", "0.3"})
      contacts += "{name = \"" + std::string(side[0] == '-' ? "l" : "r") + n + "\", body = \"b" + n + "\", at = \"b" +
                  n + ".center + b" + n + "(" + side + ", 0, -0.1)\", friction = " + friction +
                  ", static_friction = " + sticks + "},\n";
    forces += "{on = \"b" + n + "\", vector = \"t*ex\"},\n";
    initial += "z" + n + " = 0.1, ";
  }
  const auto m = contact_motion("coordinates = [" + coordinates + "]\ngravity.field = \"-9.81*ez\"\nbody = [" + bodies +
                                    "]\ncontact = [" + contacts + "]\nforce = [" + forces + "]\ninitial = {" +
                                    initial.substr(0, initial.size() - 2) + "}\n",
                                8);
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  for (int k = 0; k < kBlocks; ++k)
    for (const char* side : {"l", "r"}) {
      const auto times = test::times(m, side + std::to_string(k) + ".slips");
      ASSERT_EQ(times.size(), (0.3 + 0.05 * k) * kWeight < 8 ? 1U : 0U) << side << k;
      if (!times.empty()) {
        EXPECT_NEAR(times[0], (0.3 + 0.05 * k) * kWeight, 1e-7);
      }
    }
}

}  // namespace standing_bodies_test
}  // namespace anholon
