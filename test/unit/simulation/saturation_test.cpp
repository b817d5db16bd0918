// Forces that are nearly constant until they ramp, which Taylor series do not show from afar: no step passes over them.
// The motions are compared with closed forms, and with steps so short that each of them meets the ramp.
#include <cmath>

#include <gtest/gtest.h>

#include "ensemble/cases/ensemble.h"
#include "integrate/stepper.h"
#include "simulation/simulate.h"
#include "support/models.h"
#include "support/rows.h"

namespace anholon::saturation_test {
namespace {

struct Case {
  const char* name;
  const char* force;  // on a particle of mass a, a = 1, at x
  const char* initial;
  int to;
  double step;  // length of short steps
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

const Case kCases[] = {
    {"friction", "-tanh(x'/0.01)", "x = 0\n\"x'\" = 2", 5, 1e-3},
    {"wall", "-500*(1 + tanh((x - 1)/0.002))", "x = 0\n\"x'\" = 1", 3, 2e-4},
    {"kick", "exp(-((t - 5)/0.01)^2)/(0.01*sqrt(pi))", "x = 0\n\"x'\" = 0", 10, 1e-3},
    {"early_kick", "exp(-((t - 1/8)/0.001)^2)/(0.001*sqrt(pi))", "x = 0\n\"x'\" = 1", 2, 2e-4},
    {"ramp", "(1 + tanh((t - 3)/0.01))/2", "x = 0\n\"x'\" = 0", 6, 1e-3},
    {"strip", "-1/(1 + exp(-(x - 1)/0.005)) + 1/(1 + exp(-(x - 1.5)/0.005))", "x = 0\n\"x'\" = 2", 4, 5e-4},
    {"thin_strip", "-10/(1 + exp(-(x - 1)/0.004)) + 10/(1 + exp(-(x - 1.04)/0.004))", "x = 0\n\"x'\" = 2", 4, 4e-4},
    {"softplus_floor", "-10 + 100*log(1 + exp(-x/0.001))", "x = 1\n\"x'\" = 0", 3, 5e-5},
    {"exp_floor", "-10 + exp(-x/0.001)", "x = 1\n\"x'\" = 0", 3, 5e-5},
    {"bump", "-50*(1 - x)*exp(-((x - 1)/0.1)^2)", "x = -3\n\"x'\" = 2", 5, 1e-3},
    {"sech", "-2*sinh((x - 2)/0.05)/cosh((x - 2)/0.05)^3", "x = -3\n\"x'\" = 3", 5, 1e-3},
    {"core", "12*(0.01/x)^12/x", "x = 1\n\"x'\" = -1", 3, 1e-4},
    {"spring_on", "-x*(1 + tanh((t - 4)/0.02))", "x = 1\n\"x'\" = 0", 8, 1e-3},
};

std::string text(const Case& c, const Rational& mass = 1) {
  return std::string("coordinates = [\"x\"]\nparameters = {a = \"" + mass.get_str() +
                     "\"}\nparticle = [{name = \"p\", mass = \"a\", position = \"x*ex\"}]\nforce = [{on = \"p\", "
                     "vector = \"(") +
         c.force + ")*ex\"}]\n[initial]\n" + c.initial + "\n";
}

// x and x' at the end, by short steps in long double.
std::vector<double> by_short_steps(const Case& c, const Rational& mass = 1) {
  Scenario s;
  if (!make_scenario(test::model_of(text(c, mass)), *find_formulation("routh"), {}, s).ok()) {
    ADD_FAILURE() << c.name;
    return {};
  }
  const Program p = program(s.system, s.structure);
  StepSettings settings;
  settings.log_tolerance = std::log(1e-16);
  const std::vector<long double> parameters =
      evaluate_parameters<long double>(*s.model->graph, Column{s.model->parameters[0].value});
  Stepper<long double> stepper(p, parameters, parameters, settings);
  std::vector<long double> state{s.state.q[0], s.state.qd[0]};
  EXPECT_TRUE(stepper.start(0, state).ok());
  const int steps = static_cast<int>(std::lround(c.to / c.step));
  for (int k = 1; k <= steps; ++k) {
    const long double end = static_cast<long double>(c.to) * k / steps;
    while (!(stepper.time() == end)) {
      const Outcome o = stepper.step(end);
      if (!o.ok()) {
        ADD_FAILURE() << o.message;
        return {};
      }
    }
  }
  return {static_cast<double>(stepper.state()[0]), static_cast<double>(stepper.state()[1])};
}

class Saturation : public testing::TestWithParam<Case> {};

TEST_P(Saturation, IsNotSteppedOver) {
  const std::vector<double> expected = by_short_steps(GetParam());
  ASSERT_EQ(expected.size(), 2U);
  struct Way {
    const char* name;
    bool kernel;
    Precision precision;
    Rational tolerance;
  };
  for (const Way& way : {Way{"kernel", true, Precision::real, Rational("1/1000000000000")},
                         Way{"reference", false, Precision::real, Rational("1/1000000000000")},
                         Way{"digits", true, Precision::real, Rational("1/1000000000000000")},
                         Way{"loose", true, Precision::real, Rational("1/100000000")},
                         Way{"long", true, Precision::long_real, Rational("1/10000000000000000")},
                         Way{"quad", true, Precision::quad, Rational("1/10000000000000000000000")}}) {
    Scenario s;
    ASSERT_TRUE(make_scenario(test::model_of(text(GetParam())), *find_formulation("routh"), {}, s).ok());
    SimulationOptions o;
    o.to = GetParam().to;
    o.kernel = way.kernel;
    o.precision = way.precision;
    o.tolerance = way.tolerance;
    test::TextRows rows;
    const SimulationReport report = simulate(s, o, rows);
    ASSERT_TRUE(report.outcome.ok()) << way.name << ": " << report.outcome.message;
    const double near = way.tolerance > Rational("1/10000000000") ? 1e-3 : 1e-9;
    EXPECT_NEAR(std::stod(rows.rows().back()[1]), expected[0], near) << way.name;
    EXPECT_NEAR(std::stod(rows.rows().back()[2]), expected[1], near) << way.name;
  }
}

// A continued run repeats its last step in full, wherever the run was cut off and whatever was reported.
TEST_P(Saturation, RunsGoOnWithTheSameBits) {
  const auto go = [&](const Rational& to, const SavedRun* resume, SavedRun* saved, bool kernel) {
    Scenario s;
    EXPECT_TRUE(make_scenario(test::model_of(text(GetParam())), *find_formulation("routh"), {}, s).ok());
    SimulationOptions o;
    o.to = to;
    o.kernel = kernel;
    o.resume = resume;
    if (saved) o.save = [saved](const SavedRun& r) { *saved = r; };
    test::TextRows rows;
    const SimulationReport report = simulate(s, o, rows);
    EXPECT_TRUE(report.outcome.ok()) << report.outcome.message;
    return rows.rows().empty() ? std::vector<std::string>{} : rows.rows().back();
  };
  for (const bool kernel : {true, false}) {
    const Rational to = GetParam().to;
    SavedRun saved;
    go(to * Rational(3, 8), nullptr, &saved, kernel);
    EXPECT_EQ(go(to, &saved, nullptr, kernel), go(to, nullptr, nullptr, kernel));
  }
}

std::vector<CaseResult> swept(const Case& c, std::vector<Rational> masses) {
  Scenario s;
  EXPECT_TRUE(make_scenario(test::model_of(text(c)), *find_formulation("routh"), {}, s).ok());
  EnsembleOptions o;
  o.to = c.to;
  o.threads = 1;
  o.varied = {{Varied::Kind::parameter, 0, 0, "a"}};
  o.cases = masses.size();
  o.numbers = [&](std::size_t k) { return EnsembleCase{{masses[k]}, {}}; };
  struct Results final : CaseSink {
    void result(const CaseResult& r) override { list.push_back(r); }
    std::vector<CaseResult> list;
  } results;
  ensemble(s, o, results);
  return results.list;
}

// In the lanes of one kernel each motion ends its steps where its own force requires it, for any neighbours.
TEST_P(Saturation, IsNotSteppedOverBySweeps) {
  std::vector<Rational> masses;
  for (int k = 0; k < 70; ++k) masses.push_back(Rational(40 + k) / 40);
  const std::vector<CaseResult> together = swept(GetParam(), masses);
  ASSERT_EQ(together.size(), masses.size());
  for (const std::size_t k : {0UL, 13UL, 39UL}) {
    const std::vector<double> expected = by_short_steps(GetParam(), masses[k]);
    ASSERT_EQ(expected.size(), 2U);
    ASSERT_TRUE(together[k].outcome.ok()) << together[k].outcome.message;
    EXPECT_NEAR(together[k].last[0], expected[0], 1e-8) << k;
    EXPECT_NEAR(together[k].last[1], expected[1], 1e-8) << k;
    const std::vector<CaseResult> alone = swept(GetParam(), {masses[k]});
    ASSERT_EQ(alone.size(), 1U);
    EXPECT_EQ(alone[0].steps, together[k].steps);
    EXPECT_EQ(alone[0].last, together[k].last);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Saturation, testing::ValuesIn(kCases),
                         [](const auto& of) { return std::string(of.param.name); });

TEST(Saturation, InClosedForm) {
  // v/tanh(v/w) integrated over v: v^2/2 + w^2 pi^2/12.
  const std::vector<double> friction = by_short_steps(kCases[0]);
  EXPECT_NEAR(friction[0], 2 + 1e-4 * 9.8696044010893586 / 12, 1e-12);
  EXPECT_NEAR(friction[1], 0, 1e-12);
  const std::vector<double> kick = by_short_steps(kCases[2]);
  EXPECT_NEAR(kick[0], 5, 1e-12);
  EXPECT_NEAR(kick[1], 1, 1e-12);
}

}  // namespace
}  // namespace anholon::saturation_test
