// A state whose rate depends on the time alone is a function of the time: both give the same motion, from the same start.
#include <gtest/gtest.h>

#include "simulation/simulate.h"
#include "support/models.h"
#include "support/rows.h"

namespace anholon::states_and_functions_test {
namespace {

struct Case {
  std::string name, text;
};

// The values of x, y and their first derivatives at t = 0, 1/2 and 1.
std::vector<double> motion(const std::string& text) {
  Scenario scenario;
  const Outcome made = make_scenario(test::model_of(text), *find_formulation("routh"), {}, scenario);
  EXPECT_TRUE(made.ok()) << made.message;
  if (!made.ok()) return {};
  Workspace s(scenario);
  SimulationOptions o;
  o.to = 1;
  o.every = Rational(1, 2);
  test::TextRows rows;
  const SimulationReport r = simulate(s, o, rows);
  EXPECT_TRUE(r.outcome.ok()) << r.outcome.message;
  std::vector<double> list;
  for (const std::vector<std::string>& row : rows.rows())
    for (std::size_t k = 1; k < 5; ++k) list.push_back(std::stod(row[k]));
  return list;
}

class StatesAndFunctions : public testing::TestWithParam<Case> {};

TEST_P(StatesAndFunctions, GiveOneMotion) {
  const std::string head = "coordinates = [\"x\", \"y\"]\n"
                           "particle = [{name = \"p\", mass = 2, position = \"x*ex + y*ey\"}]\n";
  const std::string& text = GetParam().text;
  const std::vector<double> by_state = motion(head + text + "\n[state]\ns = {rate = \"cos(t)\", initial = 0.5}\n");
  const std::vector<double> by_function = motion(head + text + "\n[functions]\ns = \"0.5 + sin(t)\"\n");
  ASSERT_EQ(by_state.size(), by_function.size());
  ASSERT_EQ(by_state.size(), 12U);
  for (std::size_t i = 0; i < by_state.size(); ++i) EXPECT_NEAR(by_state[i], by_function[i], 1e-12) << i;
}

const char* const kAccelerations = "[initial]\nqddot = {x = 0.2}\nqdddot = {x = 0.1}\n";

INSTANTIATE_TEST_SUITE_P(
    Models, StatesAndFunctions,
    testing::Values(
        Case{"ForceBesideOrder4",
             "force = [{on = \"p\", vector = \"5*s*ex\"}]\nconstraint = [{name = \"c\", equation = "
             "\"D(y,4) = 2*D(x,4)\"}]\n[initial]\nlambda = {c = 0.5}"},
        Case{"Order4",
             std::string("constraint = [{name = \"c\", equation = \"D(y,4) = (1 + s)*D(x,4)\"}]\n") + kAccelerations},
        Case{"Order3", "constraint = [{name = \"c\", equation = \"y''' = s''\"}]\n[initial]\n\"y''\" = 0.7"},
        Case{"Order2", "constraint = [{name = \"c\", equation = \"y'' = s''\"}]\n[initial]\nx = 0.3\n\"y'\" = 0.2"},
        Case{"Order1", "constraint = [{name = \"c\", equation = \"y' = s'\"}]\n[initial]\nx = 0.3\n\"y'\" = 1"},
        Case{"Order0", "constraint = [{name = \"c\", equation = \"y = s'\"}]\n[initial]\nx = 0.3"},
        Case{"BothInOrder0", "constraint = [{name = \"c\", equation = \"y = (1 + s)*x + s'\"}]\n[initial]\nx = 0.3"},
        Case{"NonlinearOrder1",
             "constraint = [{name = \"c\", equation = \"x'^2 + y'^2 = 4 + s'\"}]\n[initial]\n\"x'\" = 1\nguess = "
             "{\"y'\" = 2}"},
        Case{"NonlinearOrder3", "constraint = [{name = \"c\", equation = \"x'''^2 + y'''^2 = 9\"}]\npotential.k = "
                                "\"x^2/2\"\n[initial]\nx = 1\nqddot = {x = 1, y = -1}"},
        Case{"Conditions", "potential.k = \"x^2/2 + y^2\"\n[initial]\nx = 0.3\nconditions = [\"y' = s'\"]"}),
    [](const testing::TestParamInfo<Case>& of) { return of.param.name; });

}  // namespace
}  // namespace anholon::states_and_functions_test
