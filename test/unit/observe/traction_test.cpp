// The friction that rolling needs, compared with closed forms, and systems for which no floor is known.
#include <gtest/gtest.h>

#include "observe/floors/traction.h"
#include "simulation/simulate.h"
#include "support/models.h"
#include "support/rows.h"

namespace anholon::traction_test {
namespace {

// A wheel with the driving torque M t: rolling needs the friction 2 M t/(3 R).
std::string wheel(const std::string& more = "") {
  return "coordinates = [\"x\", \"z\", \"phi\"]\nparameters = {m = 2, R = 0.3, g = 10, M = 30}\nframe.B = "
         "\"roty(phi)\"\ngravity.field = \"-g*ez\"\npoint.C = \"x*ex + z*ez\"\n[[body]]\nname = \"wheel\"\nmass = "
         "\"m\"\ninertia = [\"m*R^2/4\", \"m*R^2/2\", \"m*R^2/4\"]\ncenter = \"C\"\norientation = \"B\"\n[[force]]\non "
         "= "
         "\"wheel\"\ntorque = \"t*M*ey\"\n[[constraint]]\nname = \"rolling\"\nequation = \"vel(wheel, C - R*ez) = "
         "0\"\nalong = [\"ex\", \"ez\"]\n" +
         more + "[initial]\nz = \"R\"\n";
}

// A hoop without mass carries a load at its rim; it turns so fast at first that the load would lift it.
const char* const kHoop =
    "coordinates = [\"x\", \"phi\"]\nparameters = {m = 2, M = 0.5, R = 0.3, g = 9.81}\nframe.B = \"roty(phi)\"\n"
    "gravity.field = \"-g*ez\"\npoint.C = \"x*ex + R*ez\"\n[[body]]\nname = \"hoop\"\nmass = \"M\"\ninertia = "
    "[\"M*R^2/2\", \"M*R^2\", \"M*R^2/2\"]\ncenter = \"C\"\norientation = \"B\"\n[[particle]]\nname = \"load\"\nmass = "
    "\"m\"\nposition = \"C + R*B.z\"\n[[constraint]]\nname = \"rolling\"\nequation = \"vel(hoop, C - R*ez).x = "
    "0\"\n[initial]\n\"phi'\" = 20\n";

std::vector<std::string> notes(const std::string& text, const char* until = "1",
                               const Rational& every = Rational(1, 100)) {
  Scenario s;
  EXPECT_TRUE(make_scenario(test::model_of(text), *find_formulation("routh"), {}, s).ok());
  SimulationOptions o;
  o.to = *parse_rational(until);
  o.every = every;
  o.estimate = ErrorEstimate::never;
  test::TextRows rows;
  const SimulationReport r = simulate(s, o, rows);
  EXPECT_TRUE(r.outcome.ok()) << r.outcome.message;
  return r.notes;
}

// mu = 2 M t/(3 R m g) = 10 t/3 exceeds 1 from t = 0.3 on and is 3.33 at the end.
TEST(Traction, IsThatOfADrivenWheel) {
  const std::vector<std::string> said = notes(wheel());
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("need a friction above 1 from t = 0.3 on, at least 3.33 times the load at t = 1"),
            std::string::npos)
      << said[0];
  // The time does not depend on the rows, and is the start if the friction is too small there.
  for (const Rational& every : {Rational(1), Rational(2, 5)})
    EXPECT_NE(notes(wheel(), "1", every)[0].find("from t = 0.3 on"), std::string::npos);
  const std::string constant = test::replaced(wheel(), "t*M*ey", "M*ey");
  EXPECT_NE(notes(constant, "1", Rational(1))[0].find("from t = 0 on"), std::string::npos);
  EXPECT_TRUE(notes(wheel(), "0.3").empty()) << "below 1";
  EXPECT_TRUE(notes(test::replaced(wheel(), "M = 30", "M = 8.9")).empty()) << "below 1 to the end";
  EXPECT_TRUE(notes(test::replaced(wheel(), "g = 10", "g = 40")).empty()) << "a load four times as large";
}

// In long runs only some of the later rows are compared.
TEST(Traction, IsSeenLateInALongRun) {
  const std::vector<std::string> said = notes(wheel(), "1", Rational(1, 20000));
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("need a friction above 1 from t = 0.3 on"), std::string::npos) << said[0];
}

// A force presses the wheel down: the load is 90, the friction 66.7 at most.
TEST(Traction, CountsForcesFromOutside) {
  const std::string pressed = "[[force]]\non = \"wheel\"\nvector = \"-70*ez\"\n";
  EXPECT_TRUE(notes(wheel(pressed)).empty());
}

TEST(Traction, TellsAFloorThatPulls) {
  const std::vector<std::string> said = notes(kHoop, "0.1");
  ASSERT_FALSE(said.empty());
  EXPECT_EQ(said[0].find("the floor under constraint 'rolling' pulls down from t = 0 on"), 0u) << said[0];
  EXPECT_TRUE(notes(test::replaced(kHoop, "\"phi'\" = 20", "\"phi'\" = 1"), "0.1").empty());
}

// A disc rolls without torque down a slope whose coordinates lie in its plane: the load is m g cos(slope), and the
// friction m (g sin(slope) - x'') with x'' = 2/3 g sin(slope), so it is tan(slope)/3 of the load, 1.0473 for 1.2626 and
// 0.9647 for 1.2383.
TEST(Traction, IsThatOfASlope) {
  const std::string slope =
      "coordinates = [\"x\", \"phi\"]\nparameters = {m = 2, R = 0.3, g = 10, slope = 1.2626}\ngravity.field = "
      "\"g*(sin(slope)*ex - cos(slope)*ez)\"\npoint.C = \"x*ex + R*ez\"\n[[body]]\nname = \"disc\"\nmass = "
      "\"m\"\ninertia = [\"m*R^2/4\", \"m*R^2/2\", \"m*R^2/4\"]\ncenter = \"C\"\norientation = "
      "\"roty(phi)\"\n[[constraint]]\nname = \"rolling\"\nequation = \"vel(disc, C - R*ez).x = 0\"\n";
  const std::vector<std::string> said = notes(slope);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("needs a friction above 1 from t = 0 on, at least 1.05 times the load"), std::string::npos)
      << said[0];
  EXPECT_TRUE(notes(test::replaced(slope, "slope = 1.2626", "slope = 1.2383")).empty());
}

// The same slope, with both components of rolling and the height as a coordinate: z' = 0 holds the disc on its plane.
TEST(Traction, IsThatOfASlopeWithTheNormalComponentOfRolling) {
  const std::string slope = test::replaced(test::replaced(wheel(), "M = 30", "M = 0, slope = 1.2626"), "\"-g*ez\"",
                                           "\"g*(sin(slope)*ex - cos(slope)*ez)\"");
  const std::vector<std::string> said = notes(slope);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("constraints 'rolling.1', 'rolling.2' need a friction above 1 from t = 0 on, at least 1.05"),
            std::string::npos)
      << said[0];
  EXPECT_TRUE(notes(test::replaced(slope, "slope = 1.2626", "slope = 1.2383")).empty());
  // A guide along a line is no floor.
  EXPECT_TRUE(notes(test::replaced(slope, "along = [\"ex\", \"ez\"]", "along = [\"ex\", \"ez + x*ex\"]")).empty());
}

TEST(Traction, IsUnknownWithoutAFloor) {
  const auto any = [](const std::string& text) {
    Scenario s;
    EXPECT_TRUE(make_scenario(test::model_of(text), *find_formulation("routh"), {}, s).ok());
    return TractionWatch(s, translations(s), false).any();
  };
  EXPECT_TRUE(any(wheel()));
  EXPECT_FALSE(any(test::replaced(wheel(), "gravity.field = \"-g*ez\"\n", ""))) << "no gravity";
  EXPECT_FALSE(any(wheel("[[constraint]]\nname = \"wall\"\nequation = \"x = 0\"\n"))) << "held sideways";
  EXPECT_FALSE(any(wheel("[potential]\nspring = \"x^2\"\n"))) << "a spring to the ground";
  EXPECT_FALSE(any(test::file_text(test::source_dir() / "models/zoo/isokinetic.toml"))) << "a speed is no rolling";
}

}  // namespace
}  // namespace anholon::traction_test
