// Derivatives of rates at rest, where roots of squares of velocities have a kink.
#include <cmath>

#include <gtest/gtest.h>

#include "dynamics/rate_formulas_of.h"
#include "support/models.h"

namespace anholon::rates_at_rest_test {
namespace {

constexpr double kRoundOff = 1e-14;  // of a few operations with numbers below 10

// The derivatives by the state (x, y, x', y') of a particle in a plane on which this force acts.
RateDerivatives::Of derivatives(const std::string& force, std::vector<double> x) {
  const auto model = test::model_of("coordinates = [\"x\", \"y\"]\n"
                                    "particle = [{name = \"p\", mass = 1, position = \"x*ex + y*ey\"}]\n"
                                    "potential.s = \"x^2 + 2*y^2\"\nforce = [{on = \"p\", vector = \"" +
                                    force + "\"}]\n");
  Scenario scenario;
  EXPECT_TRUE(make_scenario(model, *find_formulation("routh"), {}, scenario).ok());
  Workspace own(scenario), of_formulas(scenario);
  std::string why;
  const auto rates = Dynamics::make(own, {}, {.minimal = false}, why);
  EXPECT_TRUE(rates) << why;
  const std::vector<double> lead = rates->leading(0, x.data(), 1);
  const FormulaValues values(rate_formulas_of(of_formulas, *rates, {}, {}));
  const FormulaPoint point{0, x, {}, lead};
  return values.derivatives({&point, 1}, FormulaValues::By::state)[0];
}

TEST(RatesAtRest, ADragHasNoDerivatives) {
  for (const char* force : {"-norm(vel(p))*vel(p)", "-sqrt(x'^2)*x'*ex", "-norm(vel(p))^(1/2)*vel(p)"}) {
    const RateDerivatives::Of d = derivatives(force, {0.5, 0, 0, 0});
    ASSERT_EQ(d.columns, 4U);
    const double expected[16] = {0, 0, 1, 0, 0, 0, 0, 1, -2, 0, 0, 0, 0, -4, 0, 0};
    for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(d.values[i], expected[i]) << force << ", entry " << i;
  }
}

TEST(RatesAtRest, InMotionItHasThem) {
  const RateDerivatives::Of d = derivatives("-norm(vel(p))*vel(p)", {0, 0, 3, 4});
  const double expected[4] = {-6.8, -2.4, -2.4, -8.2};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(d.values[(2 + i / 2) * 4 + 2 + i % 2], expected[i], kRoundOff);
}

TEST(RatesAtRest, FrictionHasAKink) {
  const RateDerivatives::Of d = derivatives("-norm(vel(p))*ex", {0.5, 0, 0, 0});
  EXPECT_EQ(d.values[2 * 4], -2);
  EXPECT_TRUE(std::isnan(d.values[2 * 4 + 2]));
  EXPECT_TRUE(std::isnan(d.values[2 * 4 + 3]));
  EXPECT_EQ(d.values[3 * 4 + 1], -4);
}

}  // namespace
}  // namespace anholon::rates_at_rest_test
