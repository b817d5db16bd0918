// The residuals of models whose states move constraints, places and contacts: they are those of the same motion with
// formulas of the time in place of the states.
#include <gtest/gtest.h>

#include "simulation/simulate.h"
#include "support/models.h"
#include "support/rows.h"

namespace anholon::residuals_with_states_test {
namespace {

SimulationReport report(const std::string& text) {
  Scenario scenario;
  const Outcome made = make_scenario(test::model_of(text), *find_formulation("routh"), {}, scenario);
  EXPECT_TRUE(made.ok()) << made.message;
  Workspace s(scenario);
  SimulationOptions o;
  o.to = 1;
  o.every = Rational(1, 4);
  test::TextRows rows;
  SimulationReport r = simulate(s, o, rows);
  EXPECT_TRUE(r.outcome.ok()) << r.outcome.message;
  return r;
}

void expect_small(const SimulationReport& r) {
  EXPECT_LT(r.newton, 1e-15);
  EXPECT_LT(r.projected, 1e-15);
  EXPECT_LT(r.constraints_kept, 1e-15);
  EXPECT_LT(r.constraints, 1e-12);  // before the projection
  EXPECT_LT(r.power, 1e-11);
}

constexpr const char* kParticle = R"toml(
gravity.field = "-9.81*ez"
state.h = {rate = "0.3*cos(2*t)", initial = 0}
)toml";

TEST(ResidualsWithStates, AStateMovesAConstraintOfPositions) {
  expect_small(report(R"toml(coordinates = ["z"]
particle = [{name = "p", mass = 1, position = "z*ez"}]
constraint = [{name = "f", equation = "z = h"}]
)toml" + std::string(kParticle)));
}

TEST(ResidualsWithStates, AStateMovesTheLengthOfARod) {
  expect_small(report(R"toml(coordinates = ["x", "z"]
particle = [{name = "p", mass = 1, position = "x*ex + z*ez"}]
constraint = [{name = "rod", equation = "x^2 + z^2 = (1 + h)^2"}]
initial = {x = 1, "z'" = 0.2}
)toml" + std::string(kParticle)));
}

TEST(ResidualsWithStates, ARateThatDependsOnTheMotion) {
  expect_small(report(R"toml(coordinates = ["x", "z"]
particle = [{name = "p", mass = 1, position = "x*ex + z*ez"}]
gravity.field = "-9.81*ez"
constraint = [{name = "rod", equation = "x^2 + z^2 = (1 + h)^2"}]
state.h = {rate = "0.1*x' - 0.2*h", initial = 0}
initial = {x = 1, "z'" = 0.2}
)toml"));
}

TEST(ResidualsWithStates, AStateMovesAPlace) {
  expect_small(report(R"toml(coordinates = ["z"]
particle = [{name = "p", mass = 1, position = "(z + h)*ez"}]
force = [{on = "p", vector = "-10*z*ez"}]
)toml" + std::string(kParticle)));
}

}  // namespace
}  // namespace anholon::residuals_with_states_test
