// Slips with two components that begin where the contact sticks.
#include <cmath>

#include <gtest/gtest.h>

#include "support/contact_motion.h"

namespace anholon {
namespace slip_start_test {

using test::contact_motion;
using test::times;

// A force that grows begins the slip without acceleration. Pushed straight the block goes by the cube of the time; a force
// that turns bends its path.
TEST(SlipStart, WithoutAcceleration) {
  const auto push = [](const std::string& turn, const std::string& friction) {
    return contact_motion(R"toml(coordinates = ["x", "y", "z"]
particle = [{name = "block", mass = 1, position = "x*ex + y*ey + z*ez"}]
contact = [{name = "floor", gap = "z", slip = ["x'", "y'"], friction = )toml" +
                              friction + "}]\nforce = [{on = \"block\", vector = \"-ez + t*(cos(" + turn +
                              "*t)*ex + sin(" + turn + "*t)*ey)\"}]\ninitial = {x = 1, y = 1}\n",
                          2);
  };
  const auto straight = push("0", "0.3");
  ASSERT_TRUE(straight.report.outcome.ok()) << straight.report.outcome.message;
  ASSERT_EQ(times(straight, "floor.slips").size(), 1U);
  EXPECT_NEAR(times(straight, "floor.slips")[0], 0.3, 2e-12);
  EXPECT_NEAR(straight.last("x"), 1 + std::pow(1.7, 3) / 6, 1e-11);
  EXPECT_EQ(straight.last("y"), 1);
  const auto turns = push("1", "0.3");
  ASSERT_TRUE(turns.report.outcome.ok()) << turns.report.outcome.message;
  EXPECT_LT(turns.report.power, 1e-10);
  EXPECT_LT(turns.report.steps, 2000U);
  EXPECT_GT(turns.last("y"), 1.1);
  EXPECT_GT(std::abs(push("0", "0.31").last("x") - straight.last("x")), 1e-3);  // the mutant
}

// A slip that begins with an acceleration is that of the same block with one component. The belt moves along x for the one, and
// aslant for the other.
TEST(SlipStart, WithAnAcceleration) {
  const auto belt = [](bool aslant, const std::string& friction) {
    const std::string head = aslant ? "coordinates = [\"x\", \"y\", \"z\"]\n" : "coordinates = [\"x\", \"z\"]\n";
    return contact_motion(
        head + "gravity.field = \"-10*ez\"\npotential.spring = \"20*" + (aslant ? "(x^2 + y^2)" : "x^2") +
            "\"\nparticle = [{name = \"block\", mass = 1, position = \"" + (aslant ? "x*ex + y*ey" : "x*ex") +
            " + z*ez\"}]\ncontact = [{name = \"belt\", gap = \"z\", friction = " + friction +
            ", static_friction = 0.4, slip = " +
            (aslant ? "[\"x' - 3/10*3/5\", \"y' - 3/10*4/5\"]}]\ninitial = {\"x'\" = \"9/50\", \"y'\" = \"6/25\"}\n"
                    : "\"x' - 3/10\"}]\ninitial = {\"x'\" = \"3/10\"}\n"),
        3);
  };
  const auto straight = belt(false, "0.25"), aslant = belt(true, "0.25");
  ASSERT_TRUE(aslant.report.outcome.ok()) << aslant.report.outcome.message;
  EXPECT_GT(times(aslant, "belt.slips").size(), 2U);
  ASSERT_EQ(times(aslant, "belt.slips").size(), times(straight, "belt.slips").size());
  for (std::size_t k = 0; k < times(aslant, "belt.slips").size(); ++k)
    EXPECT_NEAR(times(aslant, "belt.slips")[k], times(straight, "belt.slips")[k], 1e-13);
  EXPECT_NEAR(aslant.last("x"), 0.6 * straight.last("x"), 1e-14);
  EXPECT_NEAR(aslant.last("y"), 0.8 * straight.last("x"), 1e-14);
  EXPECT_GT(std::abs(belt(true, "0.26").last("x") - aslant.last("x")), 1e-3);  // the mutant
}

TEST(SlipStart, WithTooLittleFrictionFromTheStart) {
  const auto block = [](const std::string& friction) {
    return contact_motion(R"toml(coordinates = ["x", "y", "z"]
particle = [{name = "block", mass = 1, position = "x*ex + y*ey + z*ez"}]
contact = [{name = "floor", gap = "z", slip = ["x'", "y'"], friction = )toml" +
                              friction + "}]\nforce = [{on = \"block\", vector = \"3*ex + 4*ey - 10*ez\"}]\n",
                          2);
  };
  const auto m = block("0.3");
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  EXPECT_NEAR(m.last("x"), 2 * 0.6 * (5 - 0.3 * 10), 1e-14);
  EXPECT_NEAR(m.last("y"), 2 * 0.8 * (5 - 0.3 * 10), 1e-14);
  EXPECT_GT(std::abs(block("0.31").last("x") - m.last("x")), 1e-3);  // the mutant
}

// An event that ends the motion does so while the contact is held before its slip is followed.
TEST(SlipStart, EndsAtAnEvent) {
  const auto m = contact_motion(R"toml(coordinates = ["x", "y", "z"]
particle = [{name = "block", mass = 1, position = "x*ex + y*ey + z*ez"}]
contact = [{name = "floor", gap = "z", slip = ["x'", "y'"], friction = 0.25}]
force = [{on = "block", vector = "-10*ez + 3*t*(3/5*ex + 4/5*ey)"}]
event = [{name = "ends", when = "t - 0.8334", stop = true}]
)toml",
                                2);
  ASSERT_EQ(times(m, "floor.slips").size(), 1U);
  EXPECT_NEAR(times(m, "floor.slips")[0], 2.5 / 3, 1e-12);
  EXPECT_NEAR(m.last("t"), 0.8334, 1e-12);
}

}  // namespace slip_start_test
}  // namespace anholon
