// Numbers of parameters as users see them.
#include <gtest/gtest.h>

#include "modelfile/names/declared_unit.h"
#include "support/models.h"

namespace anholon::declared_unit_test {

TEST(DeclaredUnit, ParametersHaveTheNumbersOfTheFile) {
  const auto model = test::model_of(R"toml(
coordinates = ["x"]
[parameters]
a = {value = 30, unit = "deg"}
b = "a + 15 deg"
k = {value = 0.1, unit = "kN/m"}
l = "7 cm"
m = {value = 500, unit = "g"}
n = {value = 3, unit = "kg"}
r = {value = "2*l", unit = "cm"}
[[particle]]
name = "bead"
mass = "m + n"
position = "x*ex"
[potential]
V = "k*x^2/2 + k*r*l*sin(a + b)"
)toml");
  std::vector<std::string> names, units;
  for (std::size_t i = 0; i < model->parameters.size(); ++i) {
    names.push_back(model->parameters[i].name);
    units.push_back(unit_of_parameter(*model, i));
  }
  ASSERT_EQ(names, (std::vector<std::string>{"a", "b", "k", "l", "m", "n", "r"}));
  EXPECT_EQ(units, (std::vector<std::string>{"deg", "1", "kN/m", "m", "g", "kg", "cm"}));
  const std::vector<double> numbers = parameters_as_given(*model);
  EXPECT_EQ(numbers[0], 30);
  EXPECT_NEAR(numbers[1], 0.7853981633974483, 1e-15);
  EXPECT_EQ(numbers[2], 0.1);
  EXPECT_EQ(numbers[3], 0.07);
  EXPECT_EQ(numbers[4], 500);
  EXPECT_EQ(numbers[5], 3);
}

TEST(DeclaredUnit, NumbersGoBackAndForth) {
  Parameter p;
  for (const char* unit : {"deg", "arcsec", "rpm", "g", "kN/m", "lbf", "kg", "", "1/min"}) {
    p.unit = unit;
    const DeclaredUnit of = declared_unit(p);
    for (const Rational& number : {Rational(30), Rational(1, 10), Rational(-250), Rational(0)})
      EXPECT_EQ(of.number(of.in_si(number)), number) << unit;
  }
  EXPECT_TRUE(declared_unit(p).name == "1/min");
}

}  // namespace anholon::declared_unit_test
