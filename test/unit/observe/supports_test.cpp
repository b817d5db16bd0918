// Which constraints are floors, and which only look a little like one.
#include <gtest/gtest.h>

#include "observe/supports.h"
#include "support/models.h"

namespace anholon::supports_test {
namespace {

// A plate that stands on two feet, 2 apart, with its mass centre 1 above them.
std::string plate(const std::string& constraints, const std::string& more = "") {
  return "coordinates = [\"x\", \"y\", \"theta\"]\ngravity.field = \"-9.81*ey\"\npoint.rear = \"x*ex + y*ey - "
         "rotz(theta).x\"\npoint.front = \"x*ex + y*ey + rotz(theta).x\"\n" +
         more +
         "[[body]]\nname = \"plate\"\nmass = 2\ninertia = 1\ncenter = \"x*ex + y*ey + rotz(theta).y\"\nangle = "
         "\"theta\"\n" +
         constraints;
}

std::string constraint(const std::string& name, const std::string& equation) {
  return "[[constraint]]\nname = \"" + name + "\"\nequation = \"" + equation + "\"\n";
}

std::vector<std::string> floors(const std::string& text) {
  Scenario s;
  EXPECT_TRUE(make_scenario(test::model_of(text), *find_formulation("routh"), {}, s).ok());
  std::vector<std::string> names;
  for (const Support& f : supports(s)) names.push_back(s.model->constraints[f.constraint].name);
  return names;
}

TEST(Supports, AreHeightsAlone) {
  EXPECT_EQ(floors(plate(constraint("back", "rear.y = 0") + constraint("ahead", "front.y = 0"))),
            (std::vector<std::string>{"back", "ahead"}));
  EXPECT_EQ(floors(plate(constraint("back", "3*rear.y = 0"))), std::vector<std::string>{"back"}) << "times a number";
}

TEST(Supports, AreNoHingesRailsAndRods) {
  EXPECT_TRUE(
      floors(plate("[[constraint]]\nname = \"hinge\"\nequation = \"rear = -ex\"\nalong = [\"ex\", \"ey\"]\n")).empty())
      << "a hinge";
  EXPECT_TRUE(floors(plate(constraint("a", "rear.y = 0") + constraint("b", "rear.x = -1"))).empty())
      << "held sideways, too";
  EXPECT_TRUE(floors(plate(constraint("rail", "rear.y = 0.3*(rear.x + 1)"))).empty()) << "a slope";
  EXPECT_TRUE(floors(plate(constraint("wire", "rear.y = 0.1*(rear.x + 1)^2"))).empty()) << "a curve";
  EXPECT_TRUE(floors(plate(constraint("rod", "front.x^2 + front.y^2 = 1"))).empty()) << "a rod";
  EXPECT_TRUE(floors(plate(constraint("level", "theta = 0"))).empty()) << "no height";
  EXPECT_TRUE(
      floors(test::replaced(plate(constraint("back", "rear.y = 0")), "gravity.field = \"-9.81*ey\"\n", "")).empty())
      << "no gravity";
}

// Braked with 10 t at the height of the feet, the mass centre 1 above them: the load of the rear foot is m (g - a h /
// l) / 2 with m a = 10 t.
TEST(Supports, PullWhereTheLoadSaysSo) {
  Scenario s;
  ASSERT_TRUE(
      make_scenario(test::model_of(plate(constraint("back", "rear.y = 0") + constraint("ahead", "front.y = 0"))),
                    *find_formulation("routh"), {}, s)
          .ok());
  SupportWatch watch(s);
  ASSERT_TRUE(watch.any());
  // lambda of both at three moments; the equation has its height on the left, so a multiplier is the force upwards.
  const double loads[3][2] = {{9.81, 9.81}, {-1, 20.6}, {-4, 23.6}};
  for (int k = 0; k < 3; ++k) watch.see(k, [&](std::size_t r) { return loads[k][r]; });
  const std::vector<std::string> notes = watch.notes();
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0],
            "constraint 'back' looks like a floor and pulls down from t = 1 on, at most with 4 at t = 2: a "
            "body that may lift would leave it; one_sided = true in the constraint lets it open, with the equation "
            "rear.y = 0");
}

// The sign does not depend on the side on which the height stands, nor on which way the coordinate goes.
TEST(Supports, TheSignIsThatOfTheForce) {
  const auto upwards = [](const std::string& text) {
    Scenario s;
    EXPECT_TRUE(make_scenario(test::model_of(text), *find_formulation("routh"), {}, s).ok());
    const auto list = supports(s);
    return list.empty() ? 0 : list[0].upwards;
  };
  EXPECT_EQ(upwards(plate(constraint("back", "rear.y = 0"))), 1);
  EXPECT_EQ(upwards(plate(constraint("back", "0 = rear.y"))), -1);
  EXPECT_EQ(upwards(plate(constraint("back", "2*rear.y = 0"))), 2);
  const std::string depth =
      test::replaced(test::replaced(test::replaced(plate(constraint("back", "rear.y = 0")), "rear = \"x*ex + y*ey",
                                                   "rear = \"x*ex - y*ey"),
                                    "front = \"x*ex + y*ey", "front = \"x*ex - y*ey"),
                     "center = \"x*ex + y*ey", "center = \"x*ex - y*ey");
  EXPECT_EQ(upwards(depth), 1);
}

}  // namespace
}  // namespace anholon::supports_test
