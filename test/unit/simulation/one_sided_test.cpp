// Motions from and through points at which a formula has no derivatives or no value: roots, norms and unit vectors of
// zero. They are compared with closed forms.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "support/models.h"
#include "support/motion.h"

namespace anholon::one_sided_test {
namespace {

using Result = test::Motion;

Result run(const std::string& text, const Rational& to, const std::string& form = "routh",
           const std::function<void(SimulationOptions&)>& more = {}) {
  Result r;
  Scenario s;
  r.report.outcome = make_scenario(test::model_of(text), *find_formulation(form), {}, s);
  if (!r.report.outcome.ok()) return r;
  SimulationOptions o;
  o.to = to;
  o.tolerance = Rational("1/1000000000000");
  if (more) more(o);
  r.report = simulate(s, o, r.rows);
  return r;
}

// A particle of mass 1 in the plane.
std::string particle(const std::string& force, const std::string& more) {
  return "coordinates = [\"x\", \"y\"]\n" + more +
         "\n[[particle]]\nname = \"p\"\nmass = 1\nposition = [\"x\", \"y\", 0]\n[[force]]\non = \"p\"\nvector = \"" +
         force + "\"\n";
}

// Simpson's rule for a smooth function on [0, b].
double integral(const std::function<double(double)>& f, double b) {
  constexpr int kHalves = 4000;
  const double h = b / (2 * kHalves);
  double sum = f(0) + f(b);
  for (int k = 1; k < 2 * kHalves; ++k) sum += (k % 2 ? 4 : 2) * f(h * k);
  return sum * h / 3;
}

const std::string kSquare = "-norm(x'*ex + y'*ey)*(x'*ex + y'*ey) - ey";

TEST(OneSided, QuadraticDragFromRest) {
  for (const char* form : {"routh", "gibbs-appell"}) {
    const Result r = run(particle(kSquare, ""), 2, form);
    ASSERT_TRUE(r.report.outcome.ok()) << r.report.outcome.message;
    EXPECT_NEAR(r.last("y'"), -std::tanh(2), 2e-12);
    EXPECT_NEAR(r.last("y"), -std::log(std::cosh(2)), 2e-12);
    EXPECT_EQ(r.last("x"), 0);
  }
}

TEST(OneSided, BackwardsInTime) {
  const Result r = run(particle(kSquare, ""), -1);
  ASSERT_TRUE(r.report.outcome.ok()) << r.report.outcome.message;
  EXPECT_NEAR(r.last("y'"), std::tan(1), 1e-11) << "against the direction of time drag speeds the ball up";
}

TEST(OneSided, DragThroughTheHighestPoint) {
  const Result r = run(particle(kSquare, "initial = {\"y'\" = 2}"), 3);
  ASSERT_TRUE(r.report.outcome.ok()) << r.report.outcome.message;
  EXPECT_NEAR(r.last("y'"), -std::tanh(3 - std::atan(2)), 2e-12);
}

// v' = 1 - v^(3/2) has a branch point: 2 w dw / (1 - w^3) = dt with w^2 = v.
TEST(OneSided, APowerThatIsNotWholeFromRest) {
  const Result r = run(particle("-norm(x'*ex + y'*ey)^(1/2)*(x'*ex + y'*ey) - ey", ""), 1);
  ASSERT_TRUE(r.report.outcome.ok()) << r.report.outcome.message;
  const double w = std::sqrt(-r.last("y'"));
  EXPECT_NEAR(integral([](double u) { return 2 * u / (1 - u * u * u); }, w), 1, 1e-11);
}

// v' = -1 - v^(4/3) on the way up, -1 + |v|^(4/3) on the way down; v = w^3.
TEST(OneSided, APowerThatIsNotWholeThroughTheHighestPoint) {
  const Result r = run(particle("-norm(x'*ex + y'*ey)^(1/3)*(x'*ex + y'*ey) - ey", "initial = {\"y'\" = 1}"), 2);
  ASSERT_TRUE(r.report.outcome.ok()) << r.report.outcome.message;
  const double up = integral([](double w) { return 3 * w * w / (1 + w * w * w * w); }, 1);
  const double down = integral([](double w) { return 3 * w * w / (1 - w * w * w * w); }, std::cbrt(-r.last("y'")));
  EXPECT_NEAR(up + down, 2, 1e-10);
}

TEST(OneSided, ABodyThatStaysAtRestBesideOneThatMoves) {
  const std::string text = R"(coordinates = ["x", "y"]
particle = [{name = "a", mass = 1, position = "x*ex"}, {name = "b", mass = 1, position = "y*ey"}]
force = [{on = "a", vector = "-norm(x'*ex)*x'*ex + ex"}, {on = "b", vector = "-norm(y'*ey)*y'*ey"}]
)";
  const Result r = run(text, 2);
  ASSERT_TRUE(r.report.outcome.ok()) << r.report.outcome.message;
  EXPECT_NEAR(r.last("x'"), std::tanh(2), 2e-12);
  EXPECT_EQ(r.last("y"), 0);
}

TEST(OneSided, DryFrictionThatSlips) {
  const Result r = run(particle("3/5*ex + 4/5*ey - 1/2*unit(x'*ex + y'*ey)", ""), 2);
  ASSERT_TRUE(r.report.outcome.ok()) << r.report.outcome.message;
  EXPECT_NEAR(r.last("x"), 0.6, 1e-11);
  EXPECT_NEAR(r.last("y"), 0.8, 1e-11);
}

TEST(OneSided, DryFrictionThatHoldsIsNamed) {
  const Result r = run(particle("3/10*ex - 1/2*unit(x'*ex + y'*ey)", ""), 2);
  EXPECT_EQ(r.report.outcome.kind, OutcomeKind::not_a_number);
  EXPECT_NE(r.report.outcome.message.find("x'^2 + y'^2"), std::string::npos) << r.report.outcome.message;
  EXPECT_NE(r.report.outcome.message.find("at t = 0"), std::string::npos) << r.report.outcome.message;
}

TEST(OneSided, AThrustAlongNoVelocityIsNamed) {
  const Result r = run(particle("2*unit(x'*ex + y'*ey) - ey", ""), 2);
  EXPECT_EQ(r.report.outcome.kind, OutcomeKind::not_a_number) << "upwards and downwards are both solutions";
}

// x'' = -1 on one side of the origin, 1 on the other.
TEST(OneSided, AForceTowardsThePointWhereItStarts) {
  const Result r = run(particle("-unit(x*ex + y*ey)", "initial = {\"x'\" = 0.6, \"y'\" = 0.8}"), 3);
  ASSERT_TRUE(r.report.outcome.ok()) << r.report.outcome.message;
  EXPECT_NEAR(r.last("x"), -0.6 * 0.5, 1e-11);
  EXPECT_NEAR(r.last("y"), -0.8 * 0.5, 1e-11);
}

TEST(OneSided, ARootThatGrowsFromZero) {
  const Result r = run(particle("sqrt(x)*ex", "initial = {\"x'\" = 1}"), 1);
  ASSERT_TRUE(r.report.outcome.ok()) << r.report.outcome.message;
  EXPECT_NEAR(r.last("x'") * r.last("x'"), 1 + 4.0 / 3 * std::pow(r.last("x"), 1.5), 1e-11);
}

TEST(OneSided, AQuotientWithALimit) {
  const Result r = run(particle("-sin(x)/x*ey", "initial = {\"x'\" = 1}"), 2);
  ASSERT_TRUE(r.report.outcome.ok()) << r.report.outcome.message;
  EXPECT_NEAR(r.last("y'"), -1.6054129768026948, 1e-11) << "minus the sine integral of 2";
}

TEST(OneSided, WhatHasNoLimitIsNamed) {
  const Result r = run(particle("-(x*ex + y*ey)/norm(x*ex + y*ey)^3", "initial = {\"x'\" = 1}"), 2);
  EXPECT_EQ(r.report.outcome.kind, OutcomeKind::not_a_number);
  EXPECT_NE(r.report.outcome.message.find("x^2 + y^2"), std::string::npos) << r.report.outcome.message;
}

TEST(OneSided, InManyDigitsAndByOtherMethods) {
  const std::string text = particle(kSquare, "");
  const Result rk = run(text, 2, "routh", [](SimulationOptions& o) { o.method = Method::runge_kutta; });
  ASSERT_TRUE(rk.report.outcome.ok()) << rk.report.outcome.message;
  EXPECT_NEAR(rk.last("y'"), -std::tanh(2), 1e-10);
}

// The equations have no value at the end of the motion, so its row must not hold trial values of the search for one.
TEST(OneSided, WhereNoMotionGoesOnNothingLeadsTheState) {
  const std::string rolling = R"toml(coordinates = ["x", "y", "th"]
frame.B = "rotz(th)"
body = [{name = "s", mass = 2, inertia = 0.5, center = "x*ex + y*ey + 0.3*B.x", orientation = "B"}]
force = [{on = "s", vector = "sqrt(1 - x)*B.x"}]
constraint = [{name = "blade", equation = "-x'*sin(th) + y'*cos(th) = 0"}]
initial = {"x'" = 1, "th'" = 0.4}
monitor = {thrust = "sqrt(1 - x)", side = "lambda.blade"}
)toml";
  const std::string free = particle("acos(x)*ey - 3*ex", "initial = {x = 0.5, \"x'\" = 1.9}\nmonitor.a = \"x''\"");
  const std::function<void(SimulationOptions&)> numbers[] = {
      [](SimulationOptions&) {}, [](SimulationOptions& o) { o.precision = Precision::quad; },
      [](SimulationOptions& o) { o.method = Method::runge_kutta; }};
  for (const std::string& text : {rolling, free})
    for (const auto& more : numbers) {
      const Result r = run(text, 4, "routh", [&](SimulationOptions& o) {
        o.every = Rational(1, 2);
        more(o);
      });
      EXPECT_EQ(r.report.outcome.kind, OutcomeKind::not_a_number);
      EXPECT_NEAR(r.last("x"), 1, 1e-11);
      for (const char* name : {"x''", "y''", text == rolling ? "side" : "a"})
        EXPECT_TRUE(std::isnan(r.last(name))) << name << " is " << r.last(name);
      EXPECT_LT(r.report.newton, 1e-15);
      for (const WatchedReport& m : r.report.monitors) {
        EXPECT_LT(m.greatest.value, 1.001) << m.name;
        EXPECT_GE(m.least.value, -3.001) << m.name;
      }
    }
}

}  // namespace
}  // namespace anholon::one_sided_test
