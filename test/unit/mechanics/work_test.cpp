// The power of the reactions, computed by hand.
#include <gtest/gtest.h>

#include "mechanics/work.h"
#include "support/models.h"

namespace anholon::work_test {
namespace {

std::string factor(const std::string& equation) {
  const std::shared_ptr<const Model> model =
      test::model_of("coordinates = [\"x\", \"y\"]\n[parameters]\nc = 2\n[[particle]]\nname = \"p\"\nmass = "
                     "1\nposition = [\"x\", \"y\", \"0\"]\n"
                     "[[constraint]]\nname = \"r\"\nequation = \"" +
                     equation + "\"\n");
  const Mechanics m = mechanics(*model);
  return print(power_factor(m, 0), model->names, Format::text);
}

TEST(PowerFactor, OfHolonomicConstraints) {
  EXPECT_EQ(factor("x^2 + y^2 = c^2"), "0");
  EXPECT_EQ(factor("x = c*t^2"), "2*c*t");
}

TEST(PowerFactor, OfConstraintsOnVelocities) {
  EXPECT_EQ(factor("x' = y*y'"), "0");
  EXPECT_EQ(factor("x'^2 = c^2*y'^2"), "0");         // homogeneous of degree 2
  EXPECT_EQ(factor("x' = y*y' + c*x"), "c*x");       // affine: -b
  EXPECT_EQ(factor("x'^2 + y'^2 = c^2"), "2*c^2");   // the constant speed
  EXPECT_EQ(factor("c^2 = x'^2 + y'^2"), "-2*c^2");  // lambda has the other sign
  EXPECT_EQ(factor("x'^3 + y'^3 = c"), "3*c");
}

TEST(PowerFactor, OfHigherOrders) {
  EXPECT_EQ(factor("x'' = y*y''"), "x' - y*y'");  // linear, and it does work nevertheless
  EXPECT_EQ(factor("x''' = c"), "x'");
}

}  // namespace
}  // namespace anholon::work_test
