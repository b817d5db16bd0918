#include <gtest/gtest.h>

#include "simulation/simulate.h"
#include "support/models.h"
#include "support/rows.h"

namespace anholon::second_opinion_test {
namespace {

SimulationOptions options_for(Method integrator, const Model& model) {
  SimulationOptions o;
  o.to = std::min(*model.simulate.to, Rational(2));
  o.every = Rational(*o.to / 4);
  o.tolerance = Rational(1, 1000000000);
  o.integrator = integrator;
  return o;
}

struct Motion {
  explicit Motion(const std::string& text, const std::string& form = "routh") {
    start = make_scenario(test::model_of(text), *find_formulation(form), {}, scenario);
  }
  SimulationReport by(Method integrator) {
    rows = test::TextRows();
    return simulate(scenario, options_for(integrator, *scenario.model), rows);
  }
  Scenario scenario;
  Outcome start;
  test::TextRows rows;
};

struct Case {
  std::string model;
  Method integrator;
  std::string form = "routh";
};
std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << c.model << " by " << name(c.integrator) << ", " << c.form;
}

class SecondOpinionOn : public testing::TestWithParam<Case> {};

// Errors add up along the motion to at most a thousand times the tolerance of a step.
TEST_P(SecondOpinionOn, AgreesWithTaylor) {
  Motion motion(test::shipped_text(GetParam().model), GetParam().form);
  ASSERT_TRUE(motion.start.ok()) << motion.start.message;
  const SimulationReport taylor = motion.by(Method::taylor);
  const test::TextRows expected = motion.rows;
  const SimulationReport r = motion.by(GetParam().integrator);
  ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
  EXPECT_FALSE(taylor.second);
  ASSERT_TRUE(r.second);
  EXPECT_EQ(r.rows, taylor.rows);
  EXPECT_EQ(motion.rows.names(), expected.names());
  EXPECT_LT(r.second->difference, 1e-6);
  EXPECT_GT(r.second->difference, 0) << "the same bits are no second opinion";
  EXPECT_GT(r.second->steps, 4U);
  // The written rows are those of the other integrator, and the reported number is their difference from Taylor's.
  double largest = 0;
  for (std::size_t k = 0; k < r.rows; ++k)
    for (std::size_t a = 0; a < motion.scenario.model->coordinates.size(); ++a) {
      const double mine = std::stod(expected.rows()[k][a + 1]), its = std::stod(motion.rows.rows()[k][a + 1]);
      largest = std::max(largest, std::abs(its - mine) / (1 + std::abs(mine)));
    }
  EXPECT_NEAR(largest, r.second->difference, 1e-15);  // round-off of the rows
  // Accelerations and multipliers are solved for at its points; its state drifts from the constraints, and its energy
  // from the work. Newton's law also drifts if its equations are differentiated; forms without multipliers hold on the
  // constraints only.
  const Structure& t = motion.scenario.structure;
  const bool hidden =
      std::any_of(t.c.begin(), t.c.begin() + static_cast<std::ptrdiff_t>(motion.scenario.system.coordinates),
                  [](int c) { return c > 0; });
  EXPECT_LT(r.newton, hidden || GetParam().form != "routh" ? 1e-6 : 1e-12);
  EXPECT_LT(r.constraints_kept, 1e-5);  // of accelerations where order 0 is differentiated twice
  EXPECT_LT(r.power, 1e-6);
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const Method k : {Method::cvode, Method::ida}) {
    // Orders 0 (index 3), 1, 2 and 3, linear and nonlinear; a varying mass; eliminated coordinates.
    for (const char* model :
         {"zoo/double-pendulum-cartesian", "zoo/chaplygin-sleigh", "zoo/disc", "zoo/snakeboard", "zoo/isokinetic",
          "zoo/constant-acceleration", "zoo/constant-jerk", "zoo/third-order-linear", "zoo/rocket", "zoo/fourbar"})
      all.push_back({model, k});
    all.push_back({"zoo/disc", k, "chaplygin"});
    all.push_back({"papers/luo-zhao-example-2", k, "kane"});
    all.push_back({"zoo/third-order-linear", k, "maggi"});
  }
  return all;
}
INSTANTIATE_TEST_SUITE_P(Models, SecondOpinionOn, testing::ValuesIn(cases()), [](const auto& c) {
  return test::test_name(c.param.model + "_" + name(c.param.integrator) + "_" + c.param.form);
});

// The difference of the other integrator from Taylor's if one parameter is multiplied by `factor`.
double difference(Method integrator, double factor) {
  Motion motion(test::shipped_text("zoo/chaplygin-sleigh"));
  Workspace s(motion.scenario);
  motion.by(Method::taylor);
  const Program p = program(s.system, s.structure);
  std::vector<double> parameters = parameter_values<double>(*s.model);
  parameters[0] *= factor;
  Start<double> start;
  EXPECT_TRUE(initial_state(s, {}, start).ok());
  const double end = options_for(integrator, *s.model).to->get_d();
  Sundials other(p, parameters, {integrator, 1e-9, 50'000'000, {}}, start.t, end, start.state, start.leading, {});
  EXPECT_TRUE(other.advance(end).ok());
  double largest = 0;
  for (std::size_t a = 0; a < s.model->coordinates.size(); ++a)
    largest = std::max(largest, std::abs(other.state()[2 * a] - std::stod(motion.rows.rows().back()[a + 1])));
  return largest;
}

TEST(SecondOpinion, ShowsADisturbedMotion) {
  for (const Method k : {Method::cvode, Method::ida}) {
    EXPECT_LT(difference(k, 1), 1e-6);
    EXPECT_GT(difference(k, 1 + 1e-4), 1e-6);
  }
}

TEST(SecondOpinion, KeepsToItsBranch) {
  const std::string text = test::replaced(test::shipped_text("zoo/constant-acceleration"), "[simulate]",
                                          "branch = {acceleration = \"lambda > 0\"}\n[simulate]");
  for (const Method k : {Method::cvode, Method::ida}) {
    Motion motion(text);
    ASSERT_TRUE(motion.start.ok()) << motion.start.message;
    const SimulationReport r = motion.by(k);
    ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
    EXPECT_LT(r.second->difference, 1e-6);
  }
}

// Taylor's motion changes its dependent coordinates on the way, eleven times.
TEST(SecondOpinion, OnAFormWhosePivotsVanish) {
  for (const Method k : {Method::cvode, Method::ida}) {
    Motion motion(test::shipped_text("zoo/car-three-trailers"), "maggi");
    SimulationOptions o = options_for(k, *motion.scenario.model);
    o.to = Rational(20);
    o.every = Rational(5);
    o.tolerance = Rational(1, 10'000'000'000);  // at 1e-9 IDA is off by 1e-6 after 20 s
    const SimulationReport r = simulate(motion.scenario, o, motion.rows);
    ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
    EXPECT_GT(r.eliminations, 0U);
    EXPECT_EQ(r.second->form, "routh");
    EXPECT_LT(r.second->difference, 1e-6);
  }
}

TEST(SecondOpinion, GoesBackInTime) {
  for (const Method k : {Method::cvode, Method::ida}) {
    Motion motion(test::replaced(test::shipped_text("zoo/chaplygin-sleigh"), "to = 5", "to = -3"));
    ASSERT_EQ(*motion.scenario.model->simulate.to, -3);
    SimulationOptions o = options_for(k, *motion.scenario.model);
    o.every = Rational(1, 2);
    const SimulationReport r = simulate(motion.scenario, o, motion.rows);
    ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
    EXPECT_EQ(r.rows, 7U);
    EXPECT_LT(r.second->difference, 1e-6);
  }
}

TEST(SecondOpinion, SaysWhyItStops) {
  Motion motion(test::shipped_text("zoo/chaplygin-sleigh"));
  SimulationOptions o = options_for(Method::ida, *motion.scenario.model);
  o.most_steps = 50;  // enough for Taylor's series
  const SimulationReport r = simulate(motion.scenario, o, motion.rows);
  EXPECT_EQ(r.outcome.kind, OutcomeKind::interrupted);
  EXPECT_EQ(r.outcome.message.substr(0, 3), "IDA");
  EXPECT_FALSE(r.outcome.hint.empty());
  ASSERT_TRUE(r.second);
  EXPECT_EQ(r.second->steps, 50U);
}

}  // namespace
}  // namespace anholon::second_opinion_test
