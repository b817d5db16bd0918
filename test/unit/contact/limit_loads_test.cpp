// Contacts that share friction stick up to the load at which no friction within the bounds holds the body, whether or
// not their coefficients of sliding are smaller.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "support/contact_motion.h"

namespace anholon {
namespace limit_loads_test {

using test::contact_motion;

void slips_once(const test::Motion& m, const std::string& event, double at, double error) {
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  const auto times = test::times(m, event);
  ASSERT_EQ(times.size(), 1U) << event;
  EXPECT_NEAR(times[0], at, error) << event;
}

// A block on two feet is pushed at the height h above them by the force t.
struct Feet {
  double left, right, height;    // the coefficients of sticking
  double left_part, right_part;  // the parts of them that act in a slip
  double limit() const { return (left + right) * 9.81 / (1 - (right - left) * height / 0.6); }
};

test::Motion pushed(const Feet& f) {
  const auto n = [](double x) { return std::to_string(x); };
  return contact_motion(
      R"toml(coordinates = ["x", "z", "p"]
parameters = {l = 0.1, r = 0.1, h = 0.1, lp = 1, rp = 1}
gravity.field = "-9.81*ez"
body = [{name = "s", mass = 2, inertia = [0.1, 0.1, 0.1], center = "x*ex + z*ez", orientation = "roty(p)"}]
contact = [
  {name = "left", body = "s", at = "s.center + s(-0.3, 0, -h)", friction = "l*lp", static_friction = "l"},
  {name = "right", body = "s", at = "s.center + s(0.3, 0, -h)", friction = "r*rp", static_friction = "r"},
]
force = [{on = "s", vector = "t*ex"}]
initial = {z = "h"}
)toml",
      Rational(f.limit() * 1.01),
      {{"l", n(f.left)}, {"r", n(f.right)}, {"h", n(f.height)}, {"lp", n(f.left_part)}, {"rp", n(f.right_part)}});
}

TEST(LimitLoad, OfTwoFeetWithAnyCoefficients) {
  for (const Feet& f : {Feet{0.1, 0.1, 0.1, 0.8, 1}, Feet{0.1, 0.1, 0.1, 1, 0.8}, Feet{0.3, 0.6, 0.3, 1, 1},
                        Feet{0.3, 0.6, 0.3, 0.9, 1}, Feet{0.3, 0.6, 0.3, 1, 0.9}, Feet{0.25, 0.6, 0.3, 0.97, 1},
                        Feet{0.6, 0.17, 0.2, 1, 0.97}, Feet{0.42, 0.05, 0.02, 1, 1}, Feet{0.05, 0.6, 0.3, 0.8, 0.8}}) {
    const auto m = pushed(f);
    slips_once(m, "left.slips", f.limit(), 1e-9);
    slips_once(m, "right.slips", f.limit(), 1e-9);
  }
}

// A force t pulls the foot of a ladder away from the wall. Its friction at the wall may act downwards, and then N at
// the wall is m g/2/(tan(theta) - mu), which holds most.
std::string ladder() {
  return R"toml(coordinates = ["x", "z", "p", "u", "w"]
parameters = {m = 10, g = 10, l = 2, mf = 0.4, mw = 0.3, th = 1.2, r = 1, s = 30}
gravity.field = "-g*ez"
body = [{name = "lad", mass = "m", inertia = ["m*l^2/3", "m*l^2/3", "m*l^2/3"], center = "x*ex + z*ez", orientation = "roty(p)"}]
point.foot = "x*ex + z*ez + l*(cos(p)*ex - sin(p)*ez)"
point.top = "x*ex + z*ez - l*(cos(p)*ex - sin(p)*ez)"
particle = [{name = "block", mass = "s", position = "u*ex + w*ez"}]
contact = [
  {name = "block", gap = "w", slip = "u'", friction = 0.1},
  {name = "floor", gap = "foot.z", slip = "vel(lad, foot).x", friction = "mf*r", static_friction = "mf"},
  {name = "wall", gap = "top.x", slip = "vel(lad, top).z", friction = "mw*r", static_friction = "mw"},
]
force = [{on = {body = "lad", at = "foot"}, vector = "t*ex"}, {on = "block", vector = "t*ex"}]
initial = {w = 0, x = "l*cos(th)", z = "l*sin(th)", p = "th"}
)toml";
}

double limit_of_the_ladder() {
  const double wall = 50 / (std::tan(1.2) - 0.3);
  return 0.4 * (100 + 0.3 * wall) - wall;
}

TEST(LimitLoad, OfALadder) {
  const double limit = limit_of_the_ladder();
  for (const char* part : {"1", "0.999999", "0.9"}) {
    const auto m = contact_motion(ladder(), 21, {{"r", part}});
    slips_once(m, "floor.slips", limit, 1e-9);
    slips_once(m, "wall.slips", limit, 1e-9);
  }
}

// From t = 20.502 on the ladder, if pushed, would go on slipping. A block elsewhere that begins to slip does not do so.
TEST(LimitLoad, OfALadderDoesNotDependOnABlock) {
  for (const char* mass : {"20.51", "20.6"}) {
    const auto m = contact_motion(ladder(), 21, {{"s", mass}});
    slips_once(m, "block.slips", std::stod(mass), 1e-9);
    for (const char* end : {"floor.slips", "wall.slips"}) slips_once(m, end, limit_of_the_ladder(), 1e-9);
  }
}

// The limit load of four feet with equal loads is, by the upper bound of limit analysis, the least work of friction in
// a motion of the foot points in which the force has the power 1: sum mu N |v|, a convex function of two numbers, which
// is found by bisection of intervals within each other.
double least_work(double d, double angle, double bound) {
  const std::array<double, 2> f{std::cos(angle), std::sin(angle)};
  const auto work = [&](double across, double turn) {
    const double along = 1 + turn * d * f[0];
    double sum = 0;
    for (const double x : {0.4, -0.4})
      for (const double y : {0.3, -0.3})
        sum += std::hypot(f[0] * along - f[1] * across - turn * y, f[1] * along + f[0] * across + turn * x);
    return bound * sum;
  };
  const auto least = [](const auto& of) {
    double low = -20, high = 20;
    for (int k = 0; k < 120; ++k) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      (of(a) < of(b) ? high : low) = of(a) < of(b) ? b : a;
    }
    return of((low + high) / 2);
  };
  return least([&](double turn) { return least([&](double across) { return work(across, turn); }); });
}

TEST(LimitLoad, OfFourFeetThatArePushedAtAnAngle) {
  const std::string text = R"toml(coordinates = ["x", "y", "z", "pa", "pb", "pc"]
parameters = {mu = 0.45}
gravity.field = "-9.81*ez"
body = [{name = "box", mass = 3, shape = "box(0.8, 0.6, 0.2)", center = "x*ex + y*ey + z*ez", orientation = "rotz(pc)*rotx(pa)*roty(pb)"}]
contact = [{name = "f", body = "box", friction = "mu", static_friction = 0.45}]
initial = {z = 0.1}
point.P = "box.center + box(0, 0.5, -0.1)"
force = [{on = {body = "box", at = "P"}, vector = "t*(cos(0.8)*ex + sin(0.8)*ey)"}]
)toml";
  const double limit = least_work(0.5, 0.8, 0.45 * 3 * 9.81 / 4);
  EXPECT_NEAR(limit, 9.41137813, 1e-7);
  for (const char* mu : {"0.45", "0.4"}) {
    const auto m = contact_motion(text, Rational(96, 10), {{"mu", mu}});
    for (const char* foot : {"f1.slips", "f3.slips", "f4.slips"}) slips_once(m, foot, limit, 2e-9);
  }
}

}  // namespace limit_loads_test
}  // namespace anholon
