// Quantities that are watched along a motion: monitors, integrals, singular values, angles.
#include <cmath>

#include <gtest/gtest.h>

#include "simulation/run_rows.h"
#include "support/models.h"
#include "support/motion.h"

namespace anholon::monitor_test {
namespace {

using Result = test::Motion;

void run(const std::string& text, SimulationOptions o, Result& r, const char* form = "routh",
         bool with_integrals = true) {
  Scenario prepared;
  ASSERT_TRUE(make_scenario(test::model_of(text), *find_formulation(form), o.state, prepared).ok());
  Workspace s(prepared);
  if (with_integrals) o.conserved = conserved(*s.mechanics);
  r.report = simulate(s, o, r.rows);
}

const std::string kPendulum = R"toml(coordinates = ["th"]
[parameters]
g = 10
[[particle]]
name = "P"
mass = 1
position = ["sin(th)", "-cos(th)", "0"]
[gravity]
field = "-g*ey"
[initial]
th = 1
[monitor]
speed2 = "norm2(vel(P.center))"
jerk = "D(th,4)"
)toml";

// The range is over the ends of all steps, for any requested rows and any method of computing them.
TEST(Monitor, RangeDoesNotHangOnTheRows) {
  SimulationOptions o;
  o.to = 5;
  Result all;
  ASSERT_NO_FATAL_FAILURE(run(kPendulum, o, all));
  ASSERT_TRUE(all.report.outcome.ok());
  ASSERT_GT(all.report.steps, 3U);
  for (const WatchedReport& w : all.report.monitors) EXPECT_EQ(w.times, all.report.rows) << w.name;
  o.at = {5};
  for (const bool kernel : {true, false})
    for (const Precision precision : {Precision::real, Precision::long_real, Precision::quad}) {
      SimulationOptions few = o;
      few.kernel = kernel, few.precision = precision;
      SimulationOptions every = few;
      every.at.clear();
      Result r, reference;
      ASSERT_NO_FATAL_FAILURE(run(kPendulum, few, r));
      ASSERT_NO_FATAL_FAILURE(run(kPendulum, every, reference));
      EXPECT_EQ(r.report.rows, 1U);
      EXPECT_EQ(r.report.steps, reference.report.steps);
      for (std::size_t i = 0; i < r.report.monitors.size(); ++i) {
        const WatchedReport &w = r.report.monitors[i], &of = reference.report.monitors[i];
        // The kernel and the reference differ in round-off.
        const double round_off = 1e-12 * of.size;
        EXPECT_NEAR(w.least.value, of.least.value, round_off) << w.name;
        EXPECT_NEAR(w.greatest.value, of.greatest.value, round_off) << w.name;
        EXPECT_GT(w.greatest.value - w.least.value, std::abs(w.last.value - w.first.value) + 1e-3) << w.name;
        EXPECT_EQ(w.times, of.times) << w.name;
      }
    }
}

// The first 1024 steps are all looked at, later ever fewer.
TEST(Monitor, RangesOfLongMotionsAreSeenAtFewSteps) {
  std::size_t looks = 0;
  for (std::size_t step = 0; step < 1'000'000;) {
    const std::size_t next = step + steps_to_next_look(step);
    EXPECT_TRUE(is_looked_at(next)) << next;
    if (next <= 1024) {
      EXPECT_EQ(next, step + 1);
    }
    step = next, ++looks;
  }
  EXPECT_GT(looks, 5000U);
  EXPECT_LT(looks, 10000U);
}

// Values that an event sets count from the event on.
TEST(Monitor, RangeHoldsBothSidesOfAnEvent) {
  SimulationOptions o;
  o.to = 2;
  o.at = {2};
  Result r;
  ASSERT_NO_FATAL_FAILURE(run(R"toml(coordinates = ["x"]
particle = [{name = "P", mass = 1, position = "x*ex"}]
force = [{on = "P", vector = "-x'*ex"}]
event = [{when = "t - 1", set = {"x'" = "-3*x'"}}]
monitor.v = "x'"
initial = {x = 0, "x'" = 1}
)toml",
                              o, r));
  ASSERT_TRUE(r.report.outcome.ok()) << r.report.outcome.message;
  EXPECT_NEAR(r.report.monitors[0].least.value, -3 * std::exp(-1.0), 1e-13);
  EXPECT_NEAR(r.report.monitors[0].greatest.value, 1, 1e-15);
}

TEST(Monitor, FormulasAreColumnsAndARange) {
  SimulationOptions o;
  o.to = 2;
  o.every = Rational(1, 4);
  Result r;
  ASSERT_NO_FATAL_FAILURE(run(kPendulum, o, r));
  ASSERT_TRUE(r.report.outcome.ok());
  const double th = r.number(3, "th"), rate = r.number(3, "th'");
  EXPECT_NEAR(r.number(3, "speed2"), rate * rate, 1e-12);
  // th'' = -g sin(th): th'''' = g^2 sin cos + g sin th'^2
  EXPECT_NEAR(r.number(3, "jerk"), 100 * std::sin(th) * std::cos(th) + 10 * std::sin(th) * rate * rate, 1e-9);
  ASSERT_EQ(r.report.monitors.size(), 2U);
  const WatchedReport& speed2 = r.report.monitors[0];
  EXPECT_EQ(speed2.name, "speed2");
  EXPECT_EQ(speed2.first.value, 0);
  EXPECT_EQ(speed2.least.value, 0);
  EXPECT_LE(speed2.greatest.value, 20 * (1 - std::cos(1.0)) + 1e-9);
  EXPECT_EQ(speed2.largest_change, 1);
  ASSERT_EQ(r.report.conserved.size(), 1U);
  EXPECT_LT(r.report.conserved[0].largest_change, 1e-12);
}

TEST(Monitor, MultipliersInEveryForm) {
  const std::string text = test::shipped_text("zoo/chaplygin-sleigh") +
                           "\n[monitor]\nhold = \"lambda.blade_edge\"\nrate = \"lambda.blade_edge'\"\n";
  SimulationOptions o;
  o.to = 1;
  o.every = Rational(1, 2);
  Result routh, chaplygin;
  ASSERT_NO_FATAL_FAILURE(run(text, o, routh));
  ASSERT_NO_FATAL_FAILURE(run(text, o, chaplygin, "chaplygin"));
  EXPECT_EQ(routh.number(1, "hold"), routh.number(1, "lambda.blade_edge"));
  for (const char* name : {"hold", "rate"})
    EXPECT_NEAR(routh.number(2, name), chaplygin.number(2, name), 1e-11) << name;
  EXPECT_GT(std::abs(routh.number(2, "rate")), 1e-3);
}

// A disc lies down: Euler's angles fail, and the warning names them; an upright disc rolls without a warning.
TEST(Angles, NearTheirSingularityAreWarnedOf) {
  const std::string disc = test::shipped_text("zoo/disc");
  const std::string top = R"toml(coordinates = ["psi", "theta", "phi"]
[parameters]
J = 2
[[body]]
name = "top"
mass = 1
inertia = [["J", "0", "0"], ["0", "J", "0"], ["0", "0", "1"]]
center = ["0", "0", "0"]
orientation = "rotz(psi)*rotx(theta)*rotz(phi)"
[initial]
theta = 0.5
"theta'" = -1
"psi'" = 0.00001
)toml";
  SimulationOptions o;
  o.at = {Rational(1)};
  Result upright, passes;
  ASSERT_NO_FATAL_FAILURE(run(disc, o, upright));
  EXPECT_TRUE(upright.report.warnings.empty());
  ASSERT_NO_FATAL_FAILURE(run(top, o, passes));
  bool angles = false;
  for (const Warning& w : passes.report.warnings)
    angles = angles || w.message.find("the angles psi, theta, phi come near") == 0;
  EXPECT_TRUE(angles);
  // The hint suggests a quaternion.
  EXPECT_NE(passes.report.warnings.back().hint.find("'top' by a quaternion"), std::string::npos);
}

TEST(Sigma, ASingularConfigurationAnnouncesItself) {
  SimulationOptions o;
  o.at = {Rational(2)};
  o.state.overrides = {{1, 2, Rational(3, 10)}};
  Result r;
  ASSERT_NO_FATAL_FAILURE(run(test::shipped_text("zoo/appell-hamel"), o, r));
  EXPECT_EQ(r.report.outcome.kind, OutcomeKind::singular);
  EXPECT_NE(r.report.outcome.message.find("the partial derivatives of the constraint 'thread' vanish"),
            std::string::npos)
      << r.report.outcome.message;
  EXPECT_NEAR(r.report.smallest_sigma_t, r.report.t, 1e-3);
  // Nothing follows the singular configuration that could be trusted less.
  EXPECT_TRUE(r.report.warnings.empty()) << r.report.warnings[0].message;
  // A motion that ends a little before has reached its end, and its last values come from near the singularity.
  o.at = {*parse_rational("0.09935")};
  Result before;
  ASSERT_NO_FATAL_FAILURE(run(test::shipped_text("zoo/appell-hamel"), o, before));
  EXPECT_TRUE(before.report.outcome.ok()) << before.report.outcome.message;
  ASSERT_FALSE(before.report.warnings.empty());
  EXPECT_NE(before.report.warnings[0].message.find("the constraint 'thread' nearly loses its hold"), std::string::npos)
      << before.report.warnings[0].message;
}

TEST(ConstraintsEach, HaveTheirDerivatives) {
  SimulationOptions o;
  o.at = {Rational(1)};
  Result r;
  ASSERT_NO_FATAL_FAILURE(run(test::shipped_text("zoo/double-pendulum-cartesian"), o, r));
  ASSERT_EQ(r.report.constraints_each.size(), 2U);
  for (const ConstraintReport& c : r.report.constraints_each) {
    ASSERT_EQ(c.residuals.size(), 2U) << c.name;
    for (double x : c.residuals) EXPECT_LE(x, r.report.constraints_kept);
  }
  // Constraints of order 2 have no hidden derivative.
  ASSERT_NO_FATAL_FAILURE(run(test::shipped_text("zoo/second-order-linear"), o, r));
  EXPECT_EQ(r.report.constraints_each.at(0).residuals.size(), 1U);
  EXPECT_LT(r.report.constraints_kept, 1e-15);
}

}  // namespace
}  // namespace anholon::monitor_test
