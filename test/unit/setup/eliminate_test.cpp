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

}  // namespace
}  // namespace anholon::eliminate_test
