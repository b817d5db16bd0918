#include <gtest/gtest.h>

#include "observe/defect.h"
#include "simulation/simulate.h"
#include "support/models.h"
#include "support/rows.h"

namespace anholon::defect_test {
namespace {

// A bound as a number.
double number(const std::string& bound) { return std::strtod(bound.c_str(), nullptr); }

std::unique_ptr<Scenario> scenario(std::shared_ptr<const Model> model, const char* form = "routh") {
  auto s = std::make_unique<Scenario>();
  const Outcome o = make_scenario(std::move(model), *find_formulation(form), {}, *s);
  if (!o.ok()) throw std::runtime_error(o.message);
  return s;
}

// Polynomials in t, as an exact step from `begin` on.
DenseStep step(const Rational& begin, const Rational& end, const std::vector<std::vector<Rational>>& coefficients) {
  DenseStep d{Ball(begin), Ball(end), {}};
  for (const auto& c : coefficients) {
    d.coefficients.emplace_back();
    for (const Rational& r : c) d.coefficients.back().emplace_back(r);
  }
  return d;
}

RigorousReport defect(const Scenario& s, const std::vector<DenseStep>& steps, std::size_t times) {
  Workspace own(s);
  Defect d(own, times, steps.front().begin, steps.back().end, 64);
  for (const DenseStep& x : steps) d.step(x);
  return d.report().value();
}

const char* const kOscillator = "coordinates = [\"x\"]\n[[particle]]\nname = \"p\"\nmass = 1\nposition = "
                                "\"x*ex\"\n[[force]]\nname = \"f\"\non = \"p\"\nvector = \"-x*ex\"\n"
                                "[initial]\nx = 1\n";

// x = 1 - t^2/2 + t^4/24 in x'' + x = 0: the residual is t^4/24, against |x''|, |x| <= 1.
TEST(Defect, OfATruncatedCosineIsItsFirstTermLeftOut) {
  const auto s = scenario(test::model_of(kOscillator));
  const std::vector<DenseStep> cosine = {step(0, Rational(1, 2), {{1, 0, Rational(-1, 2), 0, Rational(1, 24)}})};
  const RigorousReport all = defect(*s, cosine, 0);
  EXPECT_FALSE(all.times.has_value());
  EXPECT_GE(number(all.newton), 1.0 / 384);
  EXPECT_LE(number(all.newton), 1.01 / 384);
  EXPECT_EQ(all.constraints, "0");
  // One time only, the middle: t = 1/4.
  const RigorousReport one = defect(*s, cosine, 1);
  EXPECT_EQ(one.times, 1U);
  EXPECT_GE(number(one.newton), 1.0 / 6144);
  EXPECT_LE(number(one.newton), 1.01 / 6144);
  // Backwards, and in two steps, the motion is the same.
  const std::vector<DenseStep> halves = {
      step(0, Rational(1, 4), {{1, 0, Rational(-1, 2), 0, Rational(1, 24)}}),
      step(Rational(1, 4), Rational(1, 2),
           {{1 - Rational(1, 32) + Rational(1, 6144), Rational(-1, 4) + Rational(1, 384),
             Rational(-1, 2) + Rational(1, 64), Rational(1, 24), Rational(1, 24)}})};
  const RigorousReport two = defect(*s, halves, 0);
  EXPECT_LE(number(two.newton), 1.01 / 384);
  EXPECT_LE(number(two.joints), 1e-30) << "the polynomials are one";
  const RigorousReport backwards =
      defect(*s, {step(Rational(0), Rational(-1, 2), {{1, 0, Rational(-1, 2), 0, Rational(1, 24)}})}, 0);
  EXPECT_GE(number(backwards.newton), 1.0 / 384);
  EXPECT_LE(number(backwards.newton), 1.01 / 384);
}

// x = 0 under the force 1 - cos(40 t): at the middle of the step the residual vanishes to second order, elsewhere it is
// as large as the force. Only the remainder shows it.
TEST(Defect, IsNotOnlyThatOfTheMiddle) {
  const auto s = scenario(test::model_of(test::replaced(kOscillator, "-x*ex", "(1 - cos(40*t))*ex")));
  const RigorousReport r = defect(*s, {step(Rational(-1, 4), Rational(1, 4), {{0, 0}})}, 0);
  EXPECT_GE(number(r.newton), 1);
  EXPECT_LE(number(r.newton), 2.01);
  EXPECT_GT(r.pieces, 4U);
}

TEST(Defect, CountsTheTimesThatTheMotionReached) {
  const auto s = scenario(test::model_of(kOscillator));
  Workspace own(*s);
  Defect d(own, 10, Ball(0), Ball(4), 64);
  EXPECT_FALSE(d.report().has_value());
  d.step(step(0, Rational(1, 8), {{1, 0}}));
  EXPECT_FALSE(d.report().has_value()) << "the first time is 1/5";
  d.step(step(Rational(1, 8), 1, {{1, 0}}));
  EXPECT_EQ(d.report()->times, 3U) << "1/5, 3/5, 1";
}

TEST(Defect, SeesWhereStepsDoNotJoin) {
  const auto s = scenario(test::model_of(kOscillator));
  const Rational jump(1, 1000000);
  const RigorousReport r = defect(*s, {step(0, 1, {{1, 2}}), step(1, 2, {{3, Rational(2 + jump)}})}, 0);
  EXPECT_GE(number(r.joints), 1e-6 / 2.1);
  EXPECT_LE(number(r.joints), 1.01e-6);
}

// A bead on x^2 + y^2 = 1 that moves along x = t, y = 1: phi = t^2, phi' = 2 t, phi'' = 2, which is compared with its
// two terms 2 and 0.
TEST(Defect, SeesHiddenConstraints) {
  const auto s = scenario(test::model_of(
      "coordinates = [\"x\", \"y\"]\n[[particle]]\nname = \"p\"\nmass = 1\nposition = [\"x\", \"y\", \"0\"]\n"
      "[[constraint]]\nname = \"ring\"\nequation = \"x^2 + y^2 = 1\"\n[initial]\nx = 0\ny = 1\n\"x'\" = 1\n"));
  const RigorousReport r = defect(*s, {step(0, Rational(1, 8), {{0, 1}, {1, 0}, {0}})}, 0);
  EXPECT_GE(number(r.constraints), 1);
  EXPECT_LE(number(r.constraints), 2.01);
  EXPECT_LE(number(r.newton), 0) << "no force acts, and none is needed on a straight line";
}

TEST(Defect, IsBoundedByValuesWhereAForceHasAKink) {
  const auto s = scenario(test::model_of(test::replaced(kOscillator, "-x*ex", "-abs(x)*ex")));
  // x = t: x'' = 0, the residual is |t|.
  const std::vector<DenseStep> through = {step(Rational(-1, 3), Rational(1, 4), {{Rational(-1, 3), 1}})};
  const RigorousReport all = defect(*s, through, 0);
  EXPECT_GE(number(all.newton), 1.0 / 3);
  EXPECT_LE(number(all.newton), 0.4);
  // A logarithm has no value below zero.
  const auto bad = scenario(test::model_of(test::replaced(kOscillator, "-x*ex", "-log(x)*ex")));
  EXPECT_EQ(defect(*bad, through, 0).newton, "inf");
}

// The bound for all times holds at each of many times, and is not much larger than the largest of their residuals.
class DefectOfAMotion : public testing::TestWithParam<std::pair<const char*, const char*>> {};
TEST_P(DefectOfAMotion, ForAllTimesHoldsAtMany) {
  const auto s = scenario(test::shipped(GetParam().first), GetParam().second);
  SimulationOptions o;
  o.to = Rational(1);
  o.tolerance = Rational(1, mpz_class("1000000000000"));
  test::TextRows rows;
  o.rigorous = 0;
  const SimulationReport all = simulate(*s, o, rows);
  o.rigorous = 300;
  const SimulationReport many = simulate(*s, o, rows);
  ASSERT_TRUE(all.outcome.ok() && many.outcome.ok());
  EXPECT_EQ(many.rigorous->times, 300U);
  EXPECT_LT(number(all.rigorous->newton), 1e-7);
  EXPECT_LT(number(all.rigorous->constraints), 1e-7);
  EXPECT_LT(number(all.rigorous->joints), 1e-10);
  EXPECT_LE(number(many.rigorous->newton), number(all.rigorous->newton));
  EXPECT_LE(number(many.rigorous->projected), number(all.rigorous->projected));
  EXPECT_LE(number(many.rigorous->constraints), number(all.rigorous->constraints));
  EXPECT_LT(number(all.rigorous->projected), 1e-8);
  EXPECT_LE(number(all.rigorous->newton), 10 * number(many.rigorous->newton))
      << "the largest of many times is near the bound";
}
INSTANTIATE_TEST_SUITE_P(Models, DefectOfAMotion,
                         testing::Values(std::pair("zoo/chaplygin-sleigh", "routh"),
                                         std::pair("zoo/chaplygin-sleigh", "chaplygin"),
                                         std::pair("zoo/double-pendulum-cartesian", "routh"),
                                         std::pair("papers/luo-zhao-example-2", "routh"),
                                         std::pair("zoo/constant-jerk", "routh")),
                         [](const auto& p) { return test::test_name(p.param.first) + "_" + p.param.second; });

// Tighter tolerances and wider numbers make smaller defects.
TEST(Defect, FallsWithTheToleranceInEveryNumberType) {
  const auto s = scenario(test::shipped("zoo/chaplygin-sleigh"));
  SimulationOptions o;
  o.to = Rational(1, 2);
  o.rigorous = 20;
  test::TextRows rows;
  const auto newton = [&](Precision numbers, const char* tolerance, int digits) {
    o.precision = numbers;
    o.tolerance = parse_rational(tolerance).value();
    o.digits = digits;
    return number(simulate(*s, o, rows).rigorous->newton);
  };
  EXPECT_LT(newton(Precision::real, "1e-15", 16), 1e-12);
  EXPECT_LT(newton(Precision::long_real, "1e-18", 16), 1e-15);
  EXPECT_LT(newton(Precision::quad, "1e-32", 16), 1e-29);
  EXPECT_LT(newton(Precision::multi, "1e-42", 40), 1e-38);
}

// Near a pole of the multiplier the polynomial of the multiplier is poor, those of the coordinates are not.
TEST(Defect, WithoutMultipliersIsThatOfTheMotionAlone) {
  const auto s = scenario(test::shipped("zoo/appell-hamel"));
  SimulationOptions o;
  o.to = Rational(1, 2);
  test::TextRows rows;
  for (const std::size_t times : {0U, 16U}) {
    o.rigorous = times;
    const SimulationReport r = simulate(*s, o, rows);
    EXPECT_GT(number(r.rigorous->newton), 1e-10);
    EXPECT_LT(number(r.rigorous->projected), 1e-12);
  }
}

// Mutants: one coefficient changed by 1e-9, and a force with the wrong sign, must be noticed.
TEST(Defect, OfADisturbedTrajectoryOrAWrongLawIsSeen) {
  auto s = scenario(test::shipped("zoo/chaplygin-sleigh"));
  const Program p = program(s->system, s->structure);
  StepSettings settings;
  settings.log_tolerance = natural_logarithm(Rational(1, mpz_class("1000000000000000")));
  Stepper<double> stepper(p, parameter_values<double>(*s->model), parameter_values<long double>(*s->model), settings);
  Start<long double> start;
  Workspace own(*s);
  ASSERT_TRUE(initial_state(own, {}, start).ok());
  ASSERT_TRUE(stepper.start(start.t, start.state).ok());
  ASSERT_TRUE(stepper.step(1.0L).ok());
  const DenseStep good = dense_step(stepper, stepper.time());
  for (const std::size_t times : {0U, 16U}) {
    EXPECT_LT(number(defect(*s, {good}, times).newton), 1e-11);
    EXPECT_LT(number(defect(*s, {good}, times).constraints), 1e-11);
    // x'', y'', the angle, its acceleration, the multiplier. The position of the sleigh occurs in no equation.
    for (const auto& [unknown, k] : {std::pair<std::size_t, std::size_t>(0, 2), {1, 2}, {2, 0}, {2, 2}, {3, 0}}) {
      DenseStep bad = good;
      bad.coefficients[unknown][k] += Ball(Rational(1, 1000000000));
      const RigorousReport r = defect(*s, {bad}, times);
      EXPECT_GT(std::max(number(r.newton), number(r.constraints)), 1e-10)
          << "unknown " << unknown << ", coefficient " << k;
      if (unknown == 3) {
        EXPECT_LT(number(r.projected), 1e-11) << "the multiplier is not looked at";
      } else {
        EXPECT_GT(std::max(number(r.projected), number(r.constraints)), 1e-10)
            << "unknown " << unknown << ", coefficient " << k;
      }
    }
  }
  own.mechanics->Q[2] += own.graph().number(1);
  EXPECT_GT(number(defect(own, {good}, 16).newton), 0.1) << "another torque";
  EXPECT_GT(number(defect(own, {good}, 0).projected), 0.1);
}

}  // namespace
}  // namespace anholon::defect_test
