// Slips with two components that begin at a sticking contact.
#include <cmath>

#include <gtest/gtest.h>

#include "support/contact_motion.h"

namespace anholon {
namespace slip_start_test {

using test::contact_motion;
using test::times;

// A growing force begins the slip without acceleration. The path of a straight push grows with the cube of the time; a
// turning force bends the path.
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

// A slip that begins with an acceleration is the same with one and with two components: the belt moves along x, or at
// an angle to x and y.
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

// A spring pulls a block to and fro in a straight slot: each half swing takes pi/sqrt(k) and loses 2 mu g/k. Where the
// block turns back, the slip is as small as the round-off of the velocities, and its direction is still that of the
// slot: rows agree with the state solved for again.
TEST(SlipStart, TurnsBackInASlot) {
  const auto block = [](const std::string& k) {
    return contact_motion(R"toml(coordinates = ["x", "y", "z"]
gravity.field = "-10*ez"
potential.spring = ")toml" + k +
                              R"toml(*(x^2 + y^2)/2"
particle = [{name = "block", mass = 1, position = "x*ex + y*ey + z*ez"}]
constraint = [{name = "slot", equation = "7*y = 3*x"}]
contact = [{name = "f", gap = "z", slip = ["x'", "y'"], friction = 0.1}]
initial = {x = 0.7}
)toml",
                          3);
  };
  const auto m = block("40");
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  EXPECT_TRUE(m.report.warnings.empty()) << m.report.warnings[0].message;
  const auto turns = times(m, "f.reverses");
  ASSERT_EQ(turns.size(), 6U);
  for (std::size_t n = 0; n < turns.size(); ++n)
    EXPECT_NEAR(turns[n], static_cast<double>(n + 1) * M_PI / std::sqrt(40.0), 1e-11);
  EXPECT_GT(std::abs(times(block("41"), "f.reverses")[0] - turns[0]), 1e-3);  // the mutant
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

// A block of mass 1 with a friction of at most 1, in space or in a plane.
std::string pushed(const std::string& force, bool plane = false) {
  return std::string("coordinates = [\"x\", ") + (plane ? "" : "\"y\", ") +
         "\"z\"]\ngravity.field = \"-10*ez\"\nparticle = [{name = \"block\", mass = 1, position = \"x*ex + " +
         (plane ? "" : "y*ey + ") + "z*ez\"}]\nforce = [{on = \"block\", vector = \"" + force +
         "\"}]\ncontact = [{name = \"k\", gap = \"z\", friction = 0.1, slip = " +
         (plane ? "\"x'\"" : "[\"x'\", \"y'\"]") +
         "}]\ntable = [{name = \"P\", x = [0, 1, 2, 3, 4, 9], y = [0, 1, 0, 3, 0, 0]}]\n";
}

// The slip begins at the first row, in space as in the plane, and no event reports it.
TEST(SlipStart, SlipsFromTheFirstRow) {
  for (const bool plane : {false, true}) {
    const auto m = contact_motion(pushed("3*ex", plane), 1, {}, {0, Rational(1, 2'000'000'000), 1});
    ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    EXPECT_TRUE(m.report.events.empty());
    ASSERT_EQ(m.rows.rows().size(), 3U);
    for (const std::size_t row : {0U, 1U, 2U}) {
      EXPECT_EQ(m.number(row, "k.mode"), 1);
      EXPECT_NEAR(std::abs(m.number(row, "k.friction")), 1, 1e-14);
      EXPECT_NEAR(m.number(row, "x''"), 2, 1e-14);
    }
    EXPECT_NEAR(m.number(1, "x'"), 1e-9, 1e-23);
    EXPECT_NEAR(m.last("x"), 1, 1e-14);
  }
  EXPECT_GT(contact_motion(pushed("3.1*ex"), 1).last("x"), 1.04);  // the mutant
}

// A slip that begins without an acceleration is held at first; its rows show the friction of a slip.
TEST(SlipStart, FrictionIsNeverBeyondItsBound) {
  const auto m = contact_motion(pushed("t*ex + t^2/8*ey"), 2);
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  ASSERT_EQ(times(m, "k.slips").size(), 1U);
  for (std::size_t row = 0; row < m.rows.rows().size(); ++row) {
    EXPECT_LE(m.number(row, "k.friction"), 1 + 1e-11);
    EXPECT_EQ(m.number(row, "k.mode"), m.number(row, "t") > times(m, "k.slips")[0] ? 1 : m.number(row, "k.mode"));
  }
}

// Friction that is at its bound when a mode begins passes it later: from the start, or after the end of a slip.
TEST(SlipStart, FromTheBoundOfFriction) {
  for (const bool plane : {false, true}) {
    const auto grows = contact_motion(pushed("(1 + t)*ex", plane), 2);
    ASSERT_TRUE(grows.report.outcome.ok()) << grows.report.outcome.message;
    EXPECT_NEAR(grows.last("x"), 4.0 / 3, 1e-11);
    const auto turns = contact_motion(pushed("(3 - t)*ex", plane), 8);
    ASSERT_TRUE(turns.report.outcome.ok()) << turns.report.outcome.message;
    ASSERT_EQ(times(turns, "k.sticks").size(), 1U);
    EXPECT_NEAR(times(turns, "k.sticks")[0], 4, 1e-12);
    EXPECT_NEAR(turns.last("x"), -16.0 / 3, 1e-11);
    EXPECT_GT(std::abs(contact_motion(pushed("(1 + 1.01*t)*ex", plane), 2).last("x") - 4.0 / 3), 1e-3);  // the mutant
  }
}

// The force of a table touches the bound at the knot t = 1 and falls again; it passes the bound at t = 7/3.
TEST(SlipStart, NotWhereAForceTouchesTheBound) {
  for (const bool plane : {false, true}) {
    const auto m = contact_motion(pushed("P(t)*ex", plane), 6, {}, {1, 2, 3, 4, 6});
    ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    ASSERT_EQ(times(m, "k.slips").size(), 1U);
    EXPECT_NEAR(times(m, "k.slips")[0], 7.0 / 3, 1e-12);
    ASSERT_EQ(times(m, "k.sticks").size(), 1U);
    EXPECT_NEAR(times(m, "k.sticks")[0], 31.0 / 6, 1e-12);
    EXPECT_EQ(m.number(1, "x"), 0);
    EXPECT_NEAR(m.number(2, "x'"), 2.0 / 3, 1e-11);
    EXPECT_NEAR(m.number(3, "x'"), 7.0 / 6, 1e-11);
    const auto drops = contact_motion(pushed("piecewise(t < 1, t, 0)*ex", plane), 2);
    ASSERT_TRUE(drops.report.outcome.ok()) << drops.report.outcome.message;
    EXPECT_TRUE(drops.report.events.empty());
    const auto jumps = contact_motion(pushed("piecewise(t < 1, t, 3)*ex", plane), 2);  // the mutant
    ASSERT_TRUE(jumps.report.outcome.ok()) << jumps.report.outcome.message;
    EXPECT_NEAR(jumps.last("x"), 1, 1e-13);
    // A force that stays at the bound is held until it passes the bound.
    const auto stays = contact_motion(pushed("piecewise(t < 1, t, t < 2, 1, t - 1)*ex", plane), 3);
    ASSERT_TRUE(stays.report.outcome.ok()) << stays.report.outcome.message;
    EXPECT_NEAR(stays.last("x"), 1.0 / 6, 1e-11);
  }
}

// A slip in space along an axis vanishes to the last digit.
TEST(SlipStart, AndEndsAgainExactly) {
  for (const std::string axis : {"x", "y"})
    for (const double F : {2.0, 3.0, 7.0}) {
      const auto m = contact_motion(pushed("piecewise(t < 1, " + std::to_string(F) + ", 0)*e" + axis), Rational(F + 3));
      ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
      ASSERT_EQ(times(m, "k.sticks").size(), 1U);
      EXPECT_NEAR(times(m, "k.sticks")[0], F, 1e-12);
      EXPECT_NEAR(m.last(axis), (F - 1) / 2 + (F - 1) * (F - 1) / 2, 1e-12);
    }
}

// A slip vanishes when its force jumps, so that it reverses at once, and at the end of the motion.
TEST(SlipStart, AndVanishesWhereAForceJumpsOrTheMotionEnds) {
  for (const bool plane : {false, true}) {
    const auto turns = contact_motion(
        pushed("piecewise(t < 2.5, -3, t < 4.5, 0.5, t < 5, 3, t < 6.5, -3, 0)*ex", plane), 7, {}, {0, 7});
    ASSERT_TRUE(turns.report.outcome.ok()) << turns.report.outcome.message;
    EXPECT_NEAR(turns.last("x"), -17.375, 1e-11);
    const auto ends = contact_motion(
        pushed("piecewise(t < 2, 2, t < 3.5, 0, t < 4.5, 3, t < 5.5, 1, t < 6, -2, 0)*ex", plane), 7, {}, {0, 7});
    ASSERT_TRUE(ends.report.outcome.ok()) << ends.report.outcome.message;
    EXPECT_NEAR(ends.last("x"), 9.25, 1e-11);
  }
}

// The direction of a slip turns up to its end. For a slip v, a friction f and a force F whose angle to the slip has the
// cosine c, the slip ends at v (f + F c)/(f^2 - F^2), in any unit of time.
TEST(SlipStart, EndsAtItsTimeInAnyUnitOfTime) {
  const auto end = [](const std::string& unit, const std::string& force) {
    const auto m = contact_motion("coordinates = [\"x\", \"y\", \"z\"]\nparameters.T = \"" + unit + R"toml("
gravity.field = "-10/T^2*ez"
particle = [{name = "puck", mass = 1, position = "x*ex + y*ey + z*ez"}]
contact = [{name = "ice", gap = "z", slip = ["x'", "y'"], friction = 0.3}]
force = [{on = "puck", vector = ")toml" +
                                      force + R"toml(/T^2*ey"}]
initial = {"x'" = "3/T", "y'" = "4/T"}
)toml",
                                  4 * *parse_rational(unit));
    EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    EXPECT_EQ(times(m, "ice.sticks").size(), 1U) << unit;
    return times(m, "ice.sticks").at(0) / parse_rational(unit)->get_d();
  };
  for (const std::string unit : {"1e-12", "1e-9", "1e-6", "1e-3", "1", "1e3", "1e6"})
    EXPECT_NEAR(end(unit, "1"), 5 * 3.8 / 8, 1e-9) << unit;
  EXPECT_GT(std::abs(end("1", "1.1") - 5 * 3.8 / 8), 1e-3);  // the mutant
}

// An event that ends the motion may lie in the time for which a slipping contact is still held.
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
