// A state integrates the work of contacts: energy and work balance through slipping, sticking and impacts.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "support/contact_motion.h"
#include "support/models.h"

namespace anholon::impact_states_test {
namespace {

using test::contact_motion;

// A rod that falls askew on its two ends.
const char* const kRod = R"toml(
coordinates = ["x", "z", "phi"]
parameters = {m = 0.4, l = 0.3, g = 9.81}
gravity.field = "-g*ez"
frame.B = "roty(phi)"
point.left = "x*ex + z*ez - l*B.x"
point.right = "x*ex + z*ez + l*B.x"
[[body]]
name = "rod"
mass = "m"
inertia = ["m*l^2/3", "m*l^2/3", "m*l^2/3"]
center = "x*ex + z*ez"
orientation = "B"
[[contact]]
name = "a"
gap = "left.z"
slip = "vel(rod, left).x"
friction = 0.3
restitution = 0.5
impact = "LAW"
[[contact]]
name = "b"
gap = "right.z"
slip = "vel(rod, right).x"
friction = 0.2
restitution = 0.5
impact = "LAW"
[state]
rubbed = {rate = "lambda.a.t1*vel(rod, left).x + lambda.b.t1*vel(rod, right).x", initial = 0}
struck = {rate = "lambda.a*vel(rod, left).z + lambda.b*vel(rod, right).z", initial = 0}
pushed = {rate = "lambda.a + lambda.b", initial = 0}
[initial]
z = 0.5
phi = 0.4
"x'" = 1.5
[define]
h = "m*(x'^2 + z'^2)/2 + m*l^2*phi'^2/6 + m*g*z"
[monitor]
energy = "h"
balance = "h - rubbed - struck"
momentum = "m*z' + m*g*t - pushed"
)toml";

double spread(const test::Motion& m, const std::string& monitor) {
  for (const WatchedReport& w : m.report.monitors)
    if (w.name == monitor) return w.greatest.value - w.least.value;
  ADD_FAILURE() << "no monitor " << monitor;
  return 1;
}

TEST(ImpactStates, BalanceTheEnergy) {
  for (const char* law : {"newton", "poisson"}) {
    std::string text = kRod;
    for (int k = 0; k < 2; ++k) text = test::replaced(text, "LAW", law);
    const auto m = contact_motion(text, 2);
    EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    const auto hits = std::count_if(m.report.events.begin(), m.report.events.end(),
                                    [](const EventReport& e) { return e.name.ends_with(".hits"); });
    EXPECT_GT(hits, 5) << "impacts of both ends";
    EXPECT_LT(m.last("rubbed"), -0.05) << law;
    EXPECT_LT(m.last("struck"), -0.5) << law;
    EXPECT_LT(spread(m, "balance"), 1e-12) << law;
    // The rod comes to rest when its impacts have nearly added up: the impulses still to come are at most 1e-7 of the
    // others.
    EXPECT_LT(spread(m, "momentum"), 1e-6) << law;
    EXPECT_GT(spread(m, "energy"), 0.5);
    // The mutant: the inertia of the rod differs from that in the formula of the energy.
    const auto other = contact_motion(
        test::replaced(text, "inertia = [\"m*l^2/3\", \"m*l^2/3\"", "inertia = [\"m*l^2/3\", \"m*l^2/4\""), 2);
    EXPECT_GT(spread(other, "balance"), 1e-3);
  }
}

}  // namespace
}  // namespace anholon::impact_states_test
