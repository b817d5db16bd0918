// The classes of constraints.
#include <gtest/gtest.h>

#include "setup/scenario.h"
#include "support/models.h"

namespace anholon::classes_test {
namespace {

std::string kind_of(const std::string& equation) {
  const auto model = test::model_of("coordinates = [\"x\", \"y\", \"z\"]\n"
                                    "particle = [{name = \"p\", mass = 1, position = \"x*ex + y*ey + z*ez\"}]\n"
                                    "constraint = [{name = \"c\", equation = \"" +
                                    equation + "\"}]\n");
  return classify(mechanics(*model)).front().kind;
}

// Signs and choices of velocities have no derivatives, but are not constant.
TEST(Classes, OfConstraintsWithStepsOfVelocities) {
  for (const char* equation :
       {"x' = piecewise(y' > 0.2, z', y')", "abs(x') = y'", "x' = sign(y')*z'", "x' = max(y', 2*z')"})
    EXPECT_EQ(kind_of(equation), "nonlinear") << equation;
  for (const char* equation : {"x' = abs(y)*z'", "x' = sign(y)*z'", "x' + y' = 0"})
    EXPECT_EQ(kind_of(equation), "linear") << equation;
  EXPECT_EQ(kind_of("x' = y*z' + sign(y)"), "affine");
}

}  // namespace
}  // namespace anholon::classes_test
