// The note on initial angles that may have been meant in degrees.
#include <gtest/gtest.h>

#include "setup/choice.h"
#include "setup/scenario.h"
#include "setup/start/large_angles.h"
#include "support/models.h"

namespace anholon::large_angles_test {
namespace {

// A pendulum, a bead that slides along a wave, and a wheel that has rolled.
const std::string kModel = R"toml(coordinates = ["theta", "x", "s", "phi"]
parameters = {m = 1, l = 1}
frame.wheel = "rotz(phi)"
[[particle]]
name = "bob"
mass = "m"
position = "l*(sin(theta)*ex - cos(theta)*ey)"
[[particle]]
name = "bead"
mass = "m"
position = "x*ex + cos(x)*ey"
[[body]]
name = "wheel"
mass = "m"
inertia = 1
center = "s*ex"
orientation = "wheel"
[[constraint]]
name = "rolling"
equation = "s' = l*phi'"
[gravity]
field = "-9.81*ey"
[initial]
theta = 0.3
x = 45
s = 45
phi = 100
)toml";

std::string note(const std::string& text, const StateChoice& choice = {}) {
  Scenario s;
  make_scenario(test::model_of(text), *find_formulation("routh"), choice, s);
  return note_of_large_angles(s.system, s.state, s.given_nodes, choice.overrides);
}

std::string with_theta(const std::string& value) { return test::replaced(kModel, "theta = 0.3", "theta = " + value); }

TEST(LargeAngles, LengthsAndWheelsThatHaveRolledAreNotNoted) { EXPECT_EQ(note(kModel), ""); }

TEST(LargeAngles, UsualDegreesOfEitherSignAreNoted) {
  for (const std::string value : {"30", "45", "60", "90", "180", "270", "360", "-45"})
    EXPECT_EQ(note(with_theta(value)), "theta = " + value +
                                           " at the start: angles are in radians; in degrees write theta = \"" + value +
                                           " deg\"");
  EXPECT_EQ(note(test::replaced(kModel, "phi = 100", "phi = 90")),
            "phi = 90 at the start: angles are in radians; in degrees write phi = \"90 deg\"");
}

TEST(LargeAngles, MoreThanFourTurnsAreNotedIfTheEquationsDependOnThem) {
  EXPECT_EQ(note(with_theta("25")), "");
  EXPECT_NE(note(with_theta("25.2")), "");
  EXPECT_NE(note(with_theta("-120")), "");
}

TEST(LargeAngles, DegreesWithTheirUnitAreNotNoted) {
  EXPECT_EQ(note(with_theta("\"45 deg\"")), "");
  EXPECT_EQ(note(with_theta("0.5\n\"theta'\" = 45")), "");
}

TEST(LargeAngles, AnglesWithTheirUnitAreMeantAsTheyStand) {
  for (const std::string value : {"45 rad", "2000 deg", "-10 rev", "pi/2 + 200*45 deg"})
    EXPECT_EQ(note(with_theta("\"" + value + "\"")), "") << value;
  EXPECT_NE(note(with_theta("\"45\"")), "");
  EXPECT_NE(note(with_theta("\"30*m\"")), "");
  const auto given = [](const std::string& value) {
    StateChoice choice;
    give(choice, *test::model_of(kModel), {"theta"}, read_constant(value));
    return choice;
  };
  EXPECT_EQ(note(kModel, given("45 rad")), "");
  EXPECT_NE(note(kModel, given("45")), "");
  EXPECT_NE(note(with_theta("\"45 rad\""), given("60")), "");
}

TEST(LargeAngles, TheUnitOfAFamilyIsThatOfEachMember) {
  const std::string chain = R"toml(index.i = "1..2"
coordinates = ["a[i]"]
[[particle]]
name = "P[i]"
mass = 1
position = "i*(cos(a[i])*ex + sin(a[i])*ey)"
[gravity]
field = "-9.81*ey"
[initial]
"a[i]" = "45 rad"
)toml";
  EXPECT_EQ(note(chain), "");
  EXPECT_NE(note(test::replaced(chain, "45 rad", "45")), "");
}

// Such a start contradicts the constraints, and the note may give the reason.
TEST(LargeAngles, AreAmongTheNotesOfAStartThatFails) {
  const std::string text = test::replaced(with_theta("45"), "s' = l*phi'", "theta = 1");
  Scenario s;
  EXPECT_FALSE(make_scenario(test::model_of(text), *find_formulation("routh"), {}, s).ok());
  EXPECT_EQ(s.notes, std::vector<std::string>{
                         "theta = 45 at the start: angles are in radians; in degrees write theta = \"45 deg\""});
}

}  // namespace
}  // namespace anholon::large_angles_test
