// The ten examples of the DAE view (theory: dae-view), each with its numbers: structure, dimension of the state, free
// initial values, and the end of a motion.
#include <cmath>

#include <gtest/gtest.h>

#include "observe/evaluate.h"
#include "simulation/simulate.h"
#include "support/models.h"
#include "support/rows.h"

namespace anholon::dae_examples_test {
namespace {

using Integers = std::vector<int>;

Scenario scenario(const std::shared_ptr<const Model>& model, const char* form = "routh") {
  Scenario s;
  const Outcome o = make_scenario(model, *find_formulation(form), {}, s);
  EXPECT_TRUE(o.ok()) << o.message;
  return s;
}

struct Motion {
  SimulationReport report;
  test::TextRows rows;
  double last(const std::string& column) const {
    const auto& names = rows.names();
    return std::stod(
        rows.rows().back()[static_cast<std::size_t>(std::find(names.begin(), names.end(), column) - names.begin())]);
  }
};

Motion run(const std::shared_ptr<const Model>& model, const Rational& to, const char* form = "routh") {
  Motion m;
  Scenario s;
  m.report.outcome = make_scenario(model, *find_formulation(form), {}, s);
  if (!m.report.outcome.ok()) return m;
  SimulationOptions o;
  o.tolerance = Rational(1, mpz_class("1000000000000000"));
  o.at = {to};
  m.report = simulate(s, o, m.rows);
  return m;
}

std::map<std::string, double> at_the_start(const std::shared_ptr<const Model>& model) {
  StateReport r;
  const Scenario s = scenario(model);
  EXPECT_TRUE(evaluate(s, {}, 16, r).ok());
  std::map<std::string, double> values;
  for (const auto& [name, value] : r.derivatives) values[name] = std::stod(value);
  for (const auto& [name, value] : r.lambda) values[name] = std::stod(value);
  for (const auto& [name, column] : r.forces)
    if (std::string(name) == "N")
      for (std::size_t a = 0; a < column.size(); ++a) values["N." + r.q[a].first] = std::stod(column[a]);
  return values;
}

TEST(DaeExamples, One_TheSleighHasTheSameStateInEveryForm) {
  for (const char* form : {"routh", "chaplygin", "maggi", "kane"})
    EXPECT_EQ(scenario(test::shipped("zoo/chaplygin-sleigh"), form).structure.state_dimension, 5) << form;
}

// (m - 2 lambda) r'' = F, r'' = +- A F/|F|, lambda = m/2 (1 -+ |F|/(m A)).
TEST(DaeExamples, Two_TheIsokineticParticleHasTwoBranchesAndSixNumbers) {
  const std::string text = test::shipped_text("zoo/constant-acceleration");
  EXPECT_EQ(scenario(test::model_of(text)).structure.state_dimension, 6);
  EXPECT_EQ(scenario(test::shipped("zoo/second-order-linear")).structure.state_dimension, 6);
}

TEST(DaeExamples, Three_TheOffsetsOfTheThirdOrderConstraintAreCanonical) {
  const Scenario s = scenario(test::shipped("zoo/third-order-linear"));
  EXPECT_EQ(s.structure.c, (Integers{1, 1, 0, 0}));
  EXPECT_EQ(s.structure.d, (Integers{3, 3, 2, 1}));
  EXPECT_EQ(s.structure.state_dimension, 7);
}

TEST(DaeExamples, Four_AccelerationsAreFreeUnderAConstantJerk) {
  EXPECT_EQ(scenario(test::shipped("zoo/constant-jerk")).structure.state_dimension, 9);
}

TEST(DaeExamples, Five_HolonomicConstraintsHaveIndexThree) {
  const Scenario s = scenario(test::shipped("zoo/double-pendulum-cartesian"));
  EXPECT_EQ(s.structure.c, (Integers{0, 0, 0, 0, 2, 2}));
  EXPECT_EQ(s.structure.state_dimension, 4);
}

TEST(DaeExamples, Six_TheAppellHamelMachineStopsAtItsApex) {
  const auto up =
      test::model_of(test::replaced(test::shipped_text("zoo/appell-hamel"), "\"-sqrt(5)/3\"", "\"sqrt(5)/3\""));
  EXPECT_EQ(scenario(up).structure.state_dimension, 5);
  for (const char* form : {"routh", "maggi"}) {
    const Motion m = run(up, Rational(2), form);
    EXPECT_EQ(m.report.outcome.kind, OutcomeKind::singular) << form << ": " << m.report.outcome.message;
    EXPECT_NEAR(m.report.t, std::sqrt(5.0) / 3 * 3.25 / 9.81, 1e-6) << form;
    EXPECT_NE(m.report.outcome.message.find("'thread'"), std::string::npos) << m.report.outcome.message;
  }
  EXPECT_EQ(scenario(test::shipped("zoo/appell-hamel-regularised")).structure.state_dimension, 6);
}

// A third constraint combines the two of the disc: q'' and N stay those of two constraints, and lambda is the one of
// least norm.
TEST(DaeExamples, Seven_ARedundantConstraintChangesNothing) {
  const std::string disc =
      "coordinates = [\"x\", \"y\", \"th\", \"ph\"]\n[[body]]\nname = \"disc\"\nmass = 2\ninertia = [\"1/5\", \"2/5\", "
      "\"1/5\"]\ncenter = [\"x\", \"y\", \"0\"]\n"
      "orientation = \"rotz(th)*roty(ph)\"\n[[force]]\nname = \"f\"\non = \"disc\"\nvector = [\"1\", \"x/3\", \"0\"]\n"
      "[[constraint]]\nname = \"a\"\nequation = \"x' = cos(th)*ph'/2\"\n[[constraint]]\nname = \"b\"\nequation = \"y' "
      "= sin(th)*ph'/2\"\n";
  const std::string start = "[initial]\nth = 0.4\n\"th'\" = 0.7\n\"ph'\" = 3\n";
  const std::string both =
      "[[constraint]]\nname = \"both\"\nequation = \"2*x' - 3*y' = cos(th)*ph' - 3/2*sin(th)*ph'\"\n";
  const auto two = test::model_of(disc + start), three = test::model_of(disc + both + start);
  const Scenario s = scenario(three);
  EXPECT_EQ(s.redundant.size(), 1U);
  EXPECT_EQ(s.structure.state_dimension, scenario(two).structure.state_dimension);
  const auto x = at_the_start(two), y = at_the_start(three);
  double squares = 0;
  for (const auto& [name, value] : x) {
    if (name.rfind("lambda", 0) == 0)
      squares += value * value;
    else {
      EXPECT_NEAR(y.at(name), value, 4e-16 * std::max(1.0, std::abs(value))) << name;
    }
  }
  const double la = y.at("lambda.a"), lb = y.at("lambda.b"), lc = y.at("lambda.both");
  EXPECT_NEAR(la + 2 * lc, x.at("lambda.a"), 1e-14) << "the same N";
  EXPECT_NEAR(lb - 3 * lc, x.at("lambda.b"), 1e-14);
  EXPECT_NEAR(2 * la - 3 * lb - lc, 0, 1e-14) << "nothing along the kernel";
  EXPECT_LE(la * la + lb * lb + lc * lc, squares);
}

TEST(DaeExamples, Eight_AMassThatDependsOnTheAccelerationAsksForOneMoreNumber) {
  EXPECT_EQ(scenario(test::shipped("zoo/mass-depends-on-velocity")).structure.state_dimension, 2) << "one coordinate";
  const std::string text = "coordinates = [\"x\", \"y\", \"z\"]\n[[particle]]\nname = \"p\"\nmass = \"2 + "
                           "x''/10\"\nposition = [\"x\", \"y\", \"z\"]\n"
                           "expelled_velocity = [\"1\", \"0\", \"0\"]\n[gravity]\nfield = \"-9*ez\"\n[initial]\n\"x'\" "
                           "= 1\nqddot = {x = 0.3}\n";
  const Scenario s = scenario(test::model_of(text));
  EXPECT_EQ(s.structure.state_dimension, 7);
  const Motion m = run(test::model_of(text), Rational(1, 10));
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  // m x'' = (x'''/10) 1 with m = 2 + x''/10: x''' = 20 x'' + x''^2, from x''(0) = 0.3.
  EXPECT_NEAR(m.last("x''"), 20 / (20.3 / 0.3 * std::exp(-2.0) - 1), 1e-13);
}

TEST(DaeExamples, Nine_DerivativesThatCancelDoNotCount) {
  for (const char* form : {"chaplygin", "appell-reduced", "micevic-rusov-reduced"})
    EXPECT_EQ(scenario(test::shipped("zoo/constant-acceleration"), form).structure.state_dimension, 6) << form;
}

// The same knife edge with its constraint differentiated twice: its state has two numbers more, which are constants of
// its motion.
TEST(DaeExamples, Ten_ALiftedConstraintIsAnotherSystem) {
  const std::string text = test::shipped_text("zoo/chaplygin-sleigh");
  const auto model = test::model_of(text);
  const std::string equation = model->constraints[0].equation;
  const std::size_t at = equation.find(" = ");
  const std::string lifted = "D((" + equation.substr(0, at) + ") - (" + equation.substr(at + 3) + "), 2) = 0";
  EXPECT_EQ(scenario(test::model_of(test::replaced(text, equation, lifted))).structure.state_dimension, 2 * 3 + 1);
}

// phi = x'' x''' + y''': (m - lambda) x'' = F, m y'' = lambda, and J is singular if m - lambda + m x''^2 = 0.
class ItsOwnAcceleration : public testing::Test {
 protected:
  static std::string text(const std::string& force, const std::string& lambda) {
    return "coordinates = [\"x\", \"y\"]\n[[particle]]\nname = \"p\"\nmass = 1\nposition = [\"x\", \"y\", "
           "\"0\"]\n[[force]]\nname = \"f\"\non = \"p\"\nvector = [\"" +
           force +
           "\", \"0\", \"0\"]\n[[constraint]]\nname = \"c\"\nequation = \"x''*x''' + y''' = 0\"\n[initial]\nt = "
           "0.1\nlambda = {c = " +
           lambda + "}\n";
  }
};

TEST_F(ItsOwnAcceleration, CannotStartWhereTheJacobianIsSingular) {
  const Motion m = run(test::model_of(text("0", "1")), Rational(1));
  EXPECT_EQ(m.report.outcome.kind, OutcomeKind::singular) << m.report.outcome.message;
  EXPECT_FALSE(m.report.outcome.hint.empty());
}

TEST_F(ItsOwnAcceleration, StopsWhereItBecomesSingular) {
  for (const char* form : {"routh", "maggi"}) {
    const Motion m = run(test::model_of(text("t", "1.5")), Rational(3), form);
    EXPECT_EQ(m.report.outcome.kind, OutcomeKind::singular) << form << ": " << m.report.outcome.message;
    ASSERT_FALSE(m.rows.rows().empty()) << form;
    // Near the end, lambda - m = m x''^2.
    const double a = m.last("x''");
    EXPECT_NEAR((m.last("lambda.c") - 1) / (a * a), 1, 1e-2) << form;
  }
}

TEST_F(ItsOwnAcceleration, GoesOnWhereItIsRegular) {
  EXPECT_TRUE(run(test::model_of(text("t", "0.5")), Rational(3)).report.outcome.ok());
}

// A parallelogram of bars passes its flat configuration, in which its constraints are dependent.
TEST(BetweenTwoSteps, AFoldedLinkageIsNoticed) {
  const std::string text = "coordinates = [\"a\", \"b\", \"c\"]\n[point]\nP = \"cos(a)*ex + sin(a)*ey + 2*cos(b)*ex + "
                           "2*sin(b)*ey\"\nQ = \"2*ex + cos(c)*ex + sin(c)*ey\"\n"
                           "[[particle]]\nname = \"A\"\nmass = 1\nposition = [\"cos(a)\", \"sin(a)\", "
                           "\"0\"]\n[[particle]]\nname = \"B\"\nmass = 1\nposition = \"P\"\n"
                           "[[particle]]\nname = \"C\"\nmass = 1\nposition = \"Q\"\n[gravity]\nfield = "
                           "\"-1*ey\"\n[[constraint]]\nname = \"closing\"\nequation = \"P = Q\"\n"
                           "[initial]\na = 1\n\"a'\" = -2\nguess = {b = 0, c = 1}\n";
  const Motion routh = run(test::model_of(text), Rational(5)), maggi = run(test::model_of(text), Rational(5), "maggi");
  EXPECT_EQ(routh.report.outcome.kind, OutcomeKind::singular) << routh.report.outcome.message;
  // Maggi's equations lose their pivots shortly before.
  EXPECT_FALSE(maggi.report.outcome.ok());
  for (const Motion* m : {&routh, &maggi}) {
    EXPECT_NEAR(m->report.t, 0.460032711, 2e-3);
    EXPECT_LT(m->report.t, 0.4600328);
  }
  // Bars of other lengths do not become flat together.
  const std::string other = test::replaced(text, "2*ex + cos(c)", "1.5*ex + cos(c)");
  const Motion m = run(test::model_of(other), Rational(1, 2));
  EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
}

}  // namespace
}  // namespace anholon::dae_examples_test
