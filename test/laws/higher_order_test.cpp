// Systems with constraints of order 3 and more, and nonlinear ones of order 2: every form gives the same motion, the
// energy balance closes, the hidden constraints hold, and a branch that ends stops the run.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "simulation/simulate.h"
#include "support/models.h"
#include "support/rows.h"

namespace anholon::higher_order_test {
namespace {

constexpr double kSame = 1e-13;     // two runs with tolerance 1e-15
constexpr double kBalance = 1e-14;  // power against energy

struct Motion {
  SimulationReport report;
  test::TextRows rows;
};

Motion run(const std::shared_ptr<const Model>& model, const Formulation& form, const Rational& to) {
  Motion m;
  Scenario s;
  m.report.outcome = make_scenario(model, form, {}, s);
  if (!m.report.outcome.ok()) return m;
  SimulationOptions o;
  o.tolerance = Rational(1, mpz_class("1000000000000000"));
  o.to = to;
  o.every = to / 4;
  m.report = simulate(s, o, m.rows);
  return m;
}

std::string with_order_four() {
  return "title = \"t\"\ncoordinates = [\"x\", \"y\", \"z\"]\n[[particle]]\nname = \"p\"\nmass = 2\nposition = [\"x\", "
         "\"y\", \"z\"]\n"
         "[gravity]\nfield = \"-9.81*ez + x*ey/3\"\n[[constraint]]\nname = \"snap\"\nequation = \"D(x,4) + (1 + "
         "x'/3)*D(y,4) - D(z,4)/2 = y + x' + x''*z'''\"\n"
         "[[constraint]]\nname = \"knife\"\nequation = \"z' = x*x'/3 + 0.2\"\n[initial]\nx = 1\n\"x'\" = 1\n\"y'\" = "
         "0.1\nlambda = {snap = 0.3}\n"
         "lambdadot = {snap = -0.2}\n";
}

// A force holds the rate of a state; the constraint requires the equations of motion to be differentiated.
std::string with_rate_in_force() {
  return "coordinates = [\"x\", \"y\"]\nparticle = [{name = \"p\", mass = 1, position = [\"x\", \"y\", \"0\"]}]\n"
         "state.fuel = {rate = \"-0.05*fuel\", initial = 1}\n[[force]]\non = \"p\"\nvector = \"fuel'*ey\"\n"
         "[[constraint]]\nname = \"jerk\"\nequation = \"x''' + y''' = 0\"\n";
}

class HigherOrder : public testing::TestWithParam<std::string> {
 protected:
  std::shared_ptr<const Model> model = GetParam() == "order four"      ? test::model_of(with_order_four())
                                       : GetParam() == "rate in force" ? test::model_of(with_rate_in_force())
                                                                       : test::shipped("zoo/" + GetParam());
};

TEST_P(HigherOrder, EveryFormGivesTheSameMotion) {
  const Rational end(1, 2);
  const Motion routh = run(model, *find_formulation("routh"), end);
  ASSERT_TRUE(routh.report.outcome.ok()) << routh.report.outcome.message;
  const Mechanics m = mechanics(*model);
  int forms = 0;
  for (const Formulation* form : formulations()) {
    if (!form->obstacle(m).empty() || form->unknowns == Unknowns::variational) continue;
    ++forms;
    const Motion other = run(model, *form, end);
    ASSERT_TRUE(other.report.outcome.ok()) << form->name << ": " << other.report.outcome.message;
    EXPECT_EQ(other.rows.names(), routh.rows.names()) << form->name;
    for (std::size_t i = 0; i < routh.rows.rows().size(); ++i)
      for (std::size_t k = 0; k < routh.rows.names().size(); ++k) {
        const double a = std::stod(routh.rows.rows()[i][k]), b = std::stod(other.rows.rows()[i][k]);
        EXPECT_NEAR(a, b, kSame * std::max(1.0, std::abs(a)))
            << form->name << ", " << routh.rows.names()[k] << ", row " << i;
      }
  }
  EXPECT_GE(forms, 15);
}

TEST_P(HigherOrder, TheEnergyBalanceCloses) {
  const Motion m = run(model, *find_formulation("routh"), Rational(3, 4));
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  EXPECT_LT(m.report.power, kBalance);
  EXPECT_LT(m.report.newton, 1e-15);
  EXPECT_LT(m.report.constraints_kept, 1e-15);
}

INSTANTIATE_TEST_SUITE_P(Model, HigherOrder,
                         testing::Values("third-order-linear", "constant-jerk", "constant-jerk-central",
                                         "constant-acceleration", "rheonomic-order-2", "rheonomic-order-3",
                                         "order four", "rate in force"),
                         [](const auto& p) { return test::test_name(p.param); });

// x'' = lambda and y'' = lambda + fuel' with 2 lambda' = -fuel'', lambda = 0 at the start.
TEST(RateInForce, HasItsMultiplierInClosedForm) {
  const Motion m = run(test::model_of(with_rate_in_force()), *find_formulation("routh"), Rational(1));
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  const auto& names = m.rows.names();
  const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), "lambda.jerk") - names.begin());
  ASSERT_LT(at, names.size());
  EXPECT_NEAR(std::stod(m.rows.rows().back().at(at)), 0.025 * (std::exp(-0.05) - 1), 1e-16);
}

// An input that holds a state moves a point, beside a blade: the equations hold the second derivative of the state.
TEST(StateInPlace, IsTheFunctionThatItBecomes) {
  const std::string rest =
      "coordinates = [\"x\", \"y\", \"q\"]\nparticle = [{name = \"b\", mass = \"1\", position = \"x*ex + y*ey + "
      "u*(cos(q)*ex + sin(q)*ey)\"}, {name = \"c\", mass = \"2\", position = \"x*ex + y*ey + 0.3*(cos(q)*ex + "
      "sin(q)*ey)\"}]\nconstraint = [{name = \"blade\", equation = \"y'*cos(q) - x'*sin(q) = 0\"}]\ninitial = {q = "
      "0.4, "
      "\"x'\" = 1, \"q'\" = 0.5}\n";
  const auto with = [&](const std::string& first) {
    Motion m = run(test::model_of(first + rest), *find_formulation("routh"), Rational(1));
    EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    return m;
  };
  const Motion state = with("state.z = {rate = \"-z\", initial = 1}\ninput.u = \"z*t\"\n");
  const Motion function = with("input.u = \"exp(-t)*t\"\n");
  ASSERT_EQ(state.rows.rows().size(), function.rows.rows().size());
  for (std::size_t i = 0; i < state.rows.rows().size(); ++i) {
    for (std::size_t k = 0; k <= 9; ++k) {  // t, coordinates, velocities, accelerations
      EXPECT_NEAR(std::stod(state.rows.rows()[i][k]), std::stod(function.rows.rows()[i][k]), kSame) << k;
    }
  }
}

std::string on_the_other_branch(const std::string& name) {
  std::string text = test::shipped_text("zoo/" + name);
  const std::size_t at = text.find("lambda > 0\"");
  return text.replace(at, 8, "lambda <");
}

// R(0) = 2 (1, 0.5, 1.81): |R| shrinks at the rate m c = 6.
TEST(BranchThatEnds, StopsTheRunInEveryForm) {
  const auto model = test::model_of(on_the_other_branch("constant-jerk"));
  const double end = 2 * std::sqrt(1 + 0.25 + 1.81 * 1.81) / 6;
  for (const char* form : {"routh", "chaplygin", "nielsen-reduced", "micevic-rusov-quasi-reduced", "kane"}) {
    const Motion m = run(model, *find_formulation(form), Rational(2));
    EXPECT_EQ(m.report.outcome.kind, OutcomeKind::singular) << form << ": " << m.report.outcome.message;
    EXPECT_NE(m.report.outcome.message.find("'jerk' goes to 0"), std::string::npos) << m.report.outcome.message;
    EXPECT_NEAR(m.report.t, end, 1e-9) << form;
    EXPECT_GT(m.rows.rows().size(), 1U) << "the last good state is there";
  }
}

TEST(BranchThatEnds, AlsoWhereTheReactionTurns) {
  const Motion m =
      run(test::model_of(on_the_other_branch("constant-jerk-central")), *find_formulation("routh"), Rational(20));
  EXPECT_EQ(m.report.outcome.kind, OutcomeKind::singular) << m.report.outcome.message;
  EXPECT_NEAR(m.report.t, 1.730232088, 1e-8);
}

// Without the control of the multiplier the motion is another one.
TEST(FreeMultiplier, GivesAnotherMotion) {
  std::string text = test::shipped_text("zoo/third-order-linear");
  text.erase(text.find("lambda = {control"), std::string("lambda = {control = \"2/5\"}").size());
  const auto x_at_1 = [](const std::shared_ptr<const Model>& model) {
    const Motion m = run(model, *find_formulation("routh"), Rational(1));
    return std::stod(m.rows.rows().back().at(1));
  };
  EXPECT_NEAR(x_at_1(test::model_of(text)), 0.300039477609018, 1e-14);
  EXPECT_NEAR(x_at_1(test::shipped("zoo/third-order-linear")), 0.392404103715737, 1e-14);
}

}  // namespace
}  // namespace anholon::higher_order_test
