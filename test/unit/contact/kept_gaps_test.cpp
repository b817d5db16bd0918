// Contacts whose gaps constraints keep for good, and contacts that only look so at the start.
#include <gtest/gtest.h>

#include "support/contact_motion.h"
#include "support/models.h"

namespace anholon {
namespace kept_gaps_test {

using test::contact_motion;

// A bead in a plane; `constraint` holds it, and the floor is at y = `floor`.
std::string bead(const std::string& constraint, const std::string& gap, const std::string& initial) {
  return "coordinates = [\"x\", \"y\"]\ngravity.field = \"-10*ey\"\n[[particle]]\nname = \"bead\"\nmass = 1\n"
         "position = \"x*ex + y*ey\"\n[[constraint]]\nname = \"wire\"\nequation = \"" +
         constraint + "\"\n[[contact]]\nname = \"floor\"\ngap = \"" + gap + "\"\n[initial]\n" + initial;
}

bool refused(const std::string& text) {
  const auto m = contact_motion(text, Rational(1, 2));
  return m.report.outcome.kind == OutcomeKind::inconsistent &&
         m.report.outcome.message.find("can never open") != std::string::npos;
}

TEST(KeptGaps, AreRefused) {
  EXPECT_TRUE(refused(bead("y' = 0", "y", "y = 0\n")));
  EXPECT_TRUE(refused(bead("3*y = 0", "y/2", "")));
  EXPECT_TRUE(refused(bead("x^2 + y^2 = 1", "norm2(bead) - 1", "y = -1\nguess = {x = 0}\n")));
  // The floor rises with the constraint.
  EXPECT_TRUE(refused(bead("y' = 2*t", "y - t^2", "y = 0\n")));
}

// A wire that holds the bead sideways leaves the load to the floor; a wire bent upwards, or one that is moved, opens the
// gap, although its row is that of the gap at the start.
TEST(KeptGaps, AreNotThoseThatMayOpen) {
  EXPECT_FALSE(refused(bead("x' = 0", "y", "y = 0\n")));
  EXPECT_FALSE(refused(bead("x^2 + (y - 1)^2 = 1", "y", "x = 0\ny = 0\n\"x'\" = 1\n")));
  EXPECT_FALSE(refused(bead("y = t^2", "y", "")));
  // An open gap stays open.
  EXPECT_FALSE(refused(bead("y' = 0", "y", "y = 1\n")));
}

}  // namespace kept_gaps_test
}  // namespace anholon
