// Over many steps the constraints stay at round-off and the rolling coin keeps its energy.
// `./dev test` runs 10^4 steps, `./dev long` (ANHOLON_LONG=1) all 10^6.
#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "simulation/simulate.h"
#include "support/models.h"
#include "support/rows.h"

namespace anholon::test::drift_test {
namespace {

// Bounds of the error of one step, relative to the state, and of the error after projection, relative to the terms of
// the constraint: the latter is round-off of the wider numbers that hold the state.
constexpr double kConstraintBound = 1e-13, kProjectedBound = 1e-18;
constexpr double kEnergyBound = 1e-12;

bool all_of_them() { return std::getenv("ANHOLON_LONG") != nullptr; }
std::size_t wanted_steps() { return all_of_them() ? 1'000'000 : 10'000; }

struct Motion {
  SimulationReport report;
  test::TextRows rows;
  Scenario scenario;
};

void run(const std::string& model, double seconds_per_step, Motion& m) {
  ASSERT_TRUE(make_scenario(shipped(model), *find_formulation("routh"), {}, m.scenario).ok());
  SimulationOptions o;
  o.tolerance = Rational(1, mpz_class("1000000000000000"));
  const long end = static_cast<long>(std::ceil(seconds_per_step * static_cast<double>(wanted_steps())));
  const long rows = all_of_them() ? 1000 : 20;
  for (long k = 1; k <= rows; ++k) o.at.push_back(Rational(k * end, rows));
  m.report = simulate(m.scenario, o, m.rows);
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  ASSERT_GE(m.report.steps, wanted_steps());
}

// The snakeboard's gait drives it faster and faster.
TEST(Drift, TheDrivenSnakeboardStaysOnItsConstraints) {
  Motion m;
  ASSERT_NO_FATAL_FAILURE(run("zoo/snakeboard", all_of_them() ? 0.03 : 0.125, m));
  EXPECT_LT(m.report.constraints, kConstraintBound);
  EXPECT_LT(m.report.constraints_kept, kProjectedBound);
}

// The four-bar's motor drives it faster and faster: n steps take a time that grows with the root of n.
TEST(Drift, TheFourBarStaysClosed) {
  Motion m;
  ASSERT_NO_FATAL_FAILURE(run("zoo/fourbar", all_of_them() ? 4e-4 : 4.2e-3, m));
  EXPECT_LT(m.report.constraints, kConstraintBound);
  EXPECT_LT(m.report.constraints_kept, kProjectedBound);
}

TEST(Drift, TheRollingCoinStaysOnItsConstraintsAndKeepsItsEnergy) {
  Motion m;
  ASSERT_NO_FATAL_FAILURE(run("zoo/rolling-coin", 0.022, m));
  EXPECT_LT(m.report.constraints, kConstraintBound);
  EXPECT_LT(m.report.constraints_kept, kProjectedBound);

  // Energy T + m g R sin(th) of a row, from its columns alone.
  const Model& model = *m.scenario.model;
  const Tape tape = compile(std::vector<Expr>{put_masses(model, m.scenario.mechanics->T)});
  Machine<long double> machine(tape, 0, parameter_values<long double>(model));
  const auto energy = [&](const std::vector<std::string>& row) {
    const std::size_t n = model.coordinates.size();
    const auto column = [&](std::size_t k) { return std::strtold(row[k].c_str(), nullptr); };
    for (const Input& in : tape.inputs) {
      const Node& node = model.graph->node(in.symbol);
      machine.series(in.slot)[0] = column(1 + node.order * n + node.index);
      // The heading has turned so often that its 17 digits give the direction of (x', y') to 1e-11 only. The velocity
      // is therefore taken along the heading, as the coin rolls (R = 1/2).
      if (const long double heading = column(1 + 2), rate = -column(1 + n + 4) / 2; node.order == 1 && node.index < 2)
        machine.series(in.slot)[0] = rate * (node.index == 0 ? std::cos(heading) : std::sin(heading));
    }
    machine.evaluate();
    return machine.value(0) + 9.81L / 2 * std::sin(column(1 + 3));  // m = 1, R = 1/2, g = 9.81
  };
  const long double first = energy(m.rows.rows().front());
  for (std::size_t i = 0; i < m.rows.rows().size(); ++i)
    EXPECT_LT(std::abs(static_cast<double>(energy(m.rows.rows()[i]) / first - 1)), kEnergyBound) << "row " << i;
}

}  // namespace
}  // namespace anholon::test::drift_test
