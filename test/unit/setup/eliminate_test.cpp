// The choice of the coordinates that the equations of a form eliminate.
#include <gtest/gtest.h>

#include "setup/eliminate.h"
#include "setup/scenario.h"
#include "support/models.h"

namespace anholon::eliminate_test {
namespace {

// The accelerations decide which pivot is regular: on the chosen branch x'' = 0.
const std::string kModel = R"toml(coordinates = ["x", "y"]
parameters = {g = 9.81, a = 12}
particle = [{name = "p", mass = 2, position = "x*ex + y*ey"}]
gravity.field = "-g*ey"
constraint = [{name = "c", equation = "x''^2 + y''^4/a^2 = a^2*(1 + 0.1*x*sin(t))"}]
[initial]
t = 0.3
x = 0.2
y = 0.1
"x'" = 0.5
"y'" = 1
branch = {c = "lambda > 0"}
)toml";

TEST(Eliminate, EquationsAndMotionsEliminateTheSameCoordinates) {
  const auto model = test::model_of(kModel);
  Scenario s;
  ASSERT_TRUE(make_scenario(model, *find_formulation("maggi"), {}, s).ok());
  const Mechanics m = mechanics(*model);
  const Elimination e = elimination_for(m, Unknowns::coordinates, {}, {});
  EXPECT_EQ(e.dependent, s.elimination.dependent);
  EXPECT_EQ(e.dependent, std::vector<std::size_t>{1});
  EXPECT_THROW(elimination_for(m, Unknowns::coordinates, {}, {0}), Failure);
}

// On the manifold of a the constraint d holds, and its row is a multiple of that of a.
std::string product(const std::string& d, const std::string& initial) {
  return R"toml(coordinates = ["x", "y", "z"]
particle = [{name = "p", mass = 2, position = "x*ex + y*ey + z*ez"}]
force = [{on = "p", vector = "-3*x*ex + 2*ez"}]
constraint = [{name = "a", equation = "x' + y' = 0"}, {name = "d", equation = ")toml" +
         d + "\"}]\ninitial = {" + initial + "}\n";
}

TEST(Eliminate, ConstraintsThatFollowOnTheManifoldAreLeftOutAsInAMotion) {
  const auto model = test::model_of(product("(x' + y')*z' = 0", "x = 1, \"z'\" = 1"));
  Scenario s;
  ASSERT_TRUE(make_scenario(model, *find_formulation("maggi"), {}, s).ok());
  const Mechanics m = mechanics(*model);
  for (const Unknowns unknowns : {Unknowns::coordinates, Unknowns::quasi_velocities})
    for (const bool solve : {true, false}) {
      const Elimination e = elimination_for(m, unknowns, {}, {}, solve);
      EXPECT_EQ(e.constraints, s.independent);
      EXPECT_EQ(e.left_out, s.redundant);
      EXPECT_EQ(e.left_out, std::vector<std::size_t>{1});
      EXPECT_EQ(e.full_rank, FullRank::here);
    }
}

// At z' = 0 the row of d is zero; beside this state it is a multiple of that of a.
TEST(Eliminate, AConstraintWhoseRowVanishesAtTheStartIsLeftOutIfItFollows) {
  const auto model = test::model_of(product("(x' + y')*z' = 0", "x = 1"));
  const Mechanics m = mechanics(*model);
  const Elimination e = elimination_for(m, Unknowns::coordinates, {}, {});
  EXPECT_EQ(e.constraints, std::vector<std::size_t>{0});
  EXPECT_EQ(e.left_out, std::vector<std::size_t>{1});
}

// Rows that are dependent at the start alone belong to constraints that do not follow: both take part.
TEST(Eliminate, ASingularStartLeavesNoConstraintOut) {
  const auto model = test::model_of(product("x' + y' + x^2*z' = 0", "z = 1"));
  const Mechanics m = mechanics(*model);
  const Elimination e = elimination_for(m, Unknowns::coordinates, {}, {});
  EXPECT_EQ(e.constraints.size(), 2U);
  EXPECT_TRUE(e.left_out.empty());
  EXPECT_EQ(e.full_rank, FullRank::beside);
}

// At t = 0 the rows are equal; at other times they are not.
TEST(Eliminate, AConstraintThatFollowsAtOneTimeOnlyTakesPart) {
  for (const char* d : {"x' + y' + t*z' = 0", "x' + y' + t*(z' + 1) = 0"}) {
    const auto model = test::model_of(product(d, "x = 1"));
    const Mechanics m = mechanics(*model);
    const Elimination e = elimination_for(m, Unknowns::coordinates, {}, {});
    EXPECT_EQ(e.constraints.size(), 2U) << d;
    EXPECT_TRUE(e.left_out.empty()) << d;
    EXPECT_EQ(e.full_rank, FullRank::beside) << d;
  }
}

// A driven coordinate moves with time, and so does the manifold on which the constraint follows.
TEST(Eliminate, AConstraintThatFollowsFromADriveIsLeftOut) {
  std::string text = product("(x + y - 20*t)*(z + 2) = 0", "x = 1");
  text.replace(text.find("x' + y' = 0"), 11, "x + y = 20*t");
  const auto model = test::model_of(text);
  const Mechanics m = mechanics(*model);
  const Elimination e = elimination_for(m, Unknowns::coordinates, {}, {});
  EXPECT_EQ(e.constraints, std::vector<std::size_t>{0});
  EXPECT_EQ(e.left_out, std::vector<std::size_t>{1});
}

// Constraints that are dependent everywhere have a rank that is full, and none is noted.
TEST(Eliminate, ConstraintsThatAreDependentEverywhereAreNotNoted) {
  const auto model = test::model_of(product("2*x' = -2*y'", "x = 1"));
  const Mechanics m = mechanics(*model);
  const Elimination e = elimination_for(m, Unknowns::coordinates, {}, {});
  EXPECT_EQ(e.constraints.size(), 1U);
  EXPECT_TRUE(e.left_out.empty());
  EXPECT_EQ(e.full_rank, FullRank::here);
}

}  // namespace
}  // namespace anholon::eliminate_test
