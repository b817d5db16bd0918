// Gaps that are round-off of large terms: impacts that add up on a tilted plane, far down, and a load that vanishes
// without a slip. The times are compared with closed forms.
#include <cmath>

#include <gtest/gtest.h>

#include "support/contact_motion.h"

namespace anholon {
namespace small_gaps_test {

using test::contact_motion;
using test::times;

const char* const kTilted = R"toml(coordinates = ["x", "z"]
parameters = {g = 9.81, tilt = 0.3, e = 0.7, h = 1}
gravity.field = "-g*ez"
particle = [{name = "P", mass = 1, position = "x*ex + z*ez"}]
contact = [{name = "slope", body = "P", normal = "sin(tilt)*ex + cos(tilt)*ez", restitution = "e"}]
initial = {z = "h"}
)toml";

// Velocities of up to 80 m/s are rounded by 1e-14 at each of 100 impacts, which is 3e-15 s of fall, and the intervals
// after it change by up to ten times as much.
constexpr double kRounded = 3e-12;

// The gap is h cos(tilt) at first, and the acceleration along the normal is -g cos(tilt), so the times are those on a
// level plane: sqrt(2h/g) to the first impact and 2 v e/((1 - e) g) from it, with v = sqrt(2 g h).
TEST(SmallGaps, ImpactsOnATiltedPlaneAddUpToTheLimit) {
  for (const auto& [tilt, e] : {std::pair("0", 0.9), std::pair("0.3", 0.5), std::pair("0.3", 0.9),
                                std::pair("0.8", 0.7), std::pair("0.8", 0.9), std::pair("1.3", 0.8)}) {
    Overrides o;
    o = {{"tilt", tilt}, {"e", std::to_string(e)}};
    const auto m = contact_motion(kTilted, 12, o);
    ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    const double limit = std::sqrt(2 / 9.81) * (1 + 2 * e / (1 - e));
    ASSERT_EQ(times(m, "slope.rests").size(), 1U) << tilt << " " << e;
    EXPECT_NEAR(times(m, "slope.rests")[0], limit, kRounded) << tilt << " " << e;
    // The intervals between impacts shrink by e.
    const std::vector<double> hits = times(m, "slope.hits");
    double t = std::sqrt(2 / 9.81), interval = 2 * t;
    for (std::size_t k = 0; k < hits.size(); ++k, t += interval *= e)
      EXPECT_NEAR(hits[k], t, kRounded) << tilt << " " << k;
  }
}

// A block sticks to a plate that moves up and down: its friction is zero and stays zero, also when the load vanishes.
TEST(SmallGaps, WhatLeavesWithoutASlipDoesNotSlip) {
  const auto m = contact_motion(R"toml(coordinates = ["x", "z"]
gravity.field = "-9.81*ez"
particle = [{name = "block", mass = 1, position = "x*ex + z*ez"}]
contact = [{name = "plate", gap = "z - 0.03*sin(20*t)", slip = "x'", friction = 0.3}]
initial = {"z'" = 0.6}
)toml",
                                1);
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  const std::vector<double> leaves = times(m, "plate.leaves");
  ASSERT_GT(leaves.size(), 1U);
  EXPECT_NEAR(leaves[0], std::asin(9.81 / (0.03 * 400)) / 20, 1e-14);
  EXPECT_TRUE(times(m, "plate.slips").empty());
}

}  // namespace small_gaps_test
}  // namespace anholon
