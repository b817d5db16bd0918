// Motions that pass poles of their constraints: y' = x' tan(th) means x' = 0 at a right angle, where y' is finite. The
// expected angles come from another program, which integrates equations in the speed along the blade to 12 digits.
#include <cmath>

#include <gtest/gtest.h>

#include "ensemble/cases/ensemble.h"
#include "integrate/end_check.h"
#include "integrate/stepper.h"
#include "kernel/kernel.h"
#include "lowering/quasi_velocities.h"
#include "motion/start.h"
#include "program/program.h"
#include "setup/scenario.h"
#include "support/models.h"
#include "system/cleared.h"

namespace anholon::poles_test {
namespace {

std::string sleigh(const std::string& constraint, const std::string& mass = "2") {
  return R"toml(
coordinates = ["x", "y", "th"]
force = [{generalized = {x = "-x'/2", y = "-y'/2", th = 0.8}}]
[[body]]
name = "sleigh"
mass = ")toml" +
         mass + R"toml("
inertia = 0.3
center = "(x + 0.4*cos(th))*ex + (y + 0.4*sin(th))*ey"
angle = "th"
[[constraint]]
name = "edge"
equation = ")toml" +
         constraint + R"toml("
[initial]
th = 0.3
"th'" = 0.7
)toml";
}

// A force with poles that does the same work along the blade: near the poles the series of its formula do not reach
// far.
const char* const kForceWithPoles = R"toml(
coordinates = ["x", "y", "th"]
force = [{generalized = {x = "-2*sin(th) - 0.5*x' + (2*cos(th) - 0.5*x'*sin(th)/cos(th))*sin(th)/cos(th)", th = 0.8}}]
body = [{name = "sleigh", mass = 2, inertia = 0.3, center = "(x + 0.4*cos(th))*ex + (y + 0.4*sin(th))*ey", angle = "th"}]
constraint = [{name = "edge", equation = "y' - x'*tan(th) = 0"}]
initial = {th = 0.3, "th'" = 0.7, conditions = ["x'/cos(th) = 1.2"]}
)toml";

class Results final : public CaseSink {
 public:
  void result(const CaseResult& r) override { list.push_back(r); }
  std::vector<CaseResult> list;
};

// A sweep over the given initial values of th'.
std::vector<CaseResult> sweep(const std::string& text, const std::vector<Rational>& speeds, const Rational& to) {
  Scenario scenario;
  EXPECT_TRUE(make_scenario(test::model_of(text), *find_formulation("routh"), {}, scenario).ok());
  EnsembleOptions options;
  options.to = to;
  options.threads = 1;
  options.varied = {{Varied::Kind::initial, 2, 1, ""}};
  options.cases = speeds.size();
  options.numbers = [&](std::size_t k) { return EnsembleCase{{speeds[k]}, {}}; };
  Results results;
  ensemble(scenario, options, results);
  return results.list;
}

// ---- constraints without poles --------------------------------------------------------------------------------------

struct Symbols {
  Graph g;
  Expr u = g.jet(0, 0), du = g.jet(0, 1), v = g.jet(1, 1), t = g.time();
};

TEST(Poles, AreClearedByWhatTheyDivideBy) {
  Symbols s;
  EXPECT_EQ(cleared(s.v - s.du * tan(s.u)), s.v * cos(s.u) - s.du * sin(s.u));
  EXPECT_EQ(cleared(s.v - s.du / tan(s.u)), s.v * sin(s.u) - s.du * cos(s.u));
  EXPECT_EQ(cleared(s.v - s.du / (s.u - s.t)), s.v * (s.u - s.t) - s.du);
  // The constraint is multiplied by the highest power of the common divisor of its terms.
  EXPECT_EQ(cleared(s.v / s.u - s.du / pow(s.u, 3)), s.v * pow(s.u, 2) - s.du);
  // In a sum the divisor becomes a factor.
  EXPECT_EQ(cleared(s.v - s.du * (1 + tan(s.u))), s.v * cos(s.u) - s.du * (sin(s.u) + cos(s.u)));
}

TEST(Poles, DivisorsThatAreNoPolesOfPlacesStay) {
  Symbols s;
  for (const Expr e : {s.v - s.du * sin(s.u), s.v - s.du / s.v, s.v - s.du / s.g.parameter(0), s.v * tan(s.du)})
    EXPECT_EQ(cleared(e), e);
}

// ---- motions --------------------------------------------------------------------------------------------------------

TEST(Poles, ASweepPassesThem) {
  const double angles[] = {2.6897138619641, 2.7493076694024, 2.7859590684231, 2.8521205613733, 2.8817672654327};
  const auto list =
      sweep(kForceWithPoles, {Rational(45, 100), Rational(6, 10), Rational(7, 10), Rational(9, 10), Rational(1)}, 3);
  ASSERT_EQ(list.size(), std::size(angles));
  for (std::size_t k = 0; k < list.size(); ++k) {
    ASSERT_TRUE(list[k].outcome.ok()) << list[k].outcome.message;
    EXPECT_NEAR(list[k].last[2], angles[k], 1e-11);
  }
}

// Three velocities, and a pole of a rational function: the constraint without division has the same motion.
TEST(Poles, AreThoseOfTheWritingAlone) {
  const std::vector<Rational> speeds{Rational(45, 100), Rational(7, 10), Rational(108, 100)};
  for (const auto& [with, without] : {std::pair{"y' = (x' + 0.3*th')/(th - 1)", "(th - 1)*y' = x' + 0.3*th'"},
                                      {"y' = x'/(th - 1)", "(th - 1)*y' = x'"},
                                      {"y' = (x' + 0.3*th')/(th - 1)^3", "(th - 1)^3*y' = x' + 0.3*th'"}}) {
    const auto a = sweep(sleigh(with), speeds, 3), b = sweep(sleigh(without), speeds, 3);
    for (std::size_t k = 0; k < speeds.size(); ++k) {
      ASSERT_TRUE(a[k].outcome.ok()) << with << ": " << a[k].outcome.message;
      ASSERT_TRUE(b[k].outcome.ok()) << without << ": " << b[k].outcome.message;
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[k].last[i], b[k].last[i], 1e-10) << with;
    }
  }
}

// Equations with a varying mass have no writing in quasi-velocities, and equations with a pole lose their digits at it:
// the motion ends there, or its remainder is right.
TEST(Poles, NoMotionGoesOnWithoutDigits) {
  std::vector<Rational> speeds;
  for (int k = 0; k < 8; ++k) speeds.push_back(Rational(45 + 9 * k, 100));
  const std::string mass = "2 + sin(t)/5";
  const auto a = sweep(sleigh("y' = x'/(th - 1)", mass), speeds, 3),
             b = sweep(sleigh("(th - 1)*y' = x'", mass), speeds, 3);
  for (std::size_t k = 0; k < speeds.size(); ++k) {
    ASSERT_TRUE(b[k].outcome.ok()) << b[k].outcome.message;
    if (a[k].outcome.ok())
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[k].last[i], b[k].last[i], 1e-5);
    else
      EXPECT_NEAR(a[k].last[2], 1, 1e-6) << "it ends at the pole";
  }
}

TEST(EndCheck, DigitsThatRoundOffHasTakenAreNoted) {
  using Next = EndCheck<double>::Next;
  const auto lost = [](double rate) {
    EndCheck<double> check(std::log(1e-12));
    check.begin(1, {});
    EXPECT_EQ(check.seen(rate), Next::look);
    EXPECT_EQ(check.seen(rate), Next::look) << "near the start of the step";
    EXPECT_EQ(check.seen(rate), Next::look) << "nearer";
    EXPECT_EQ(check.seen(rate), Next::good) << "as large as near the start";
    return check.loses_digits();
  };
  EXPECT_FALSE(lost(5e-10));
  EXPECT_TRUE(lost(1e-8));
}

TEST(EndCheck, AShortStepThatEndsWithAnotherRateIsLookedAt) {
  const EndCheck<double> check(std::log(1e-12));
  EXPECT_TRUE(check.passes_at_once(1e-4, 1e-12));
  EXPECT_FALSE(check.passes_at_once(2, 1e-12));
  EXPECT_TRUE(check.may_jump(2, 1e-12));
  EXPECT_TRUE(check.may_jump(1e-4, 0.1)) << "over the reach of the series";
  EXPECT_FALSE(check.may_jump(1e-4, 1e-12));
}

// ---- quasi-velocities that change their sign ------------------------------------------------------------------------

// Multiplies p by the sign of cos(th). The series of a step do not show the change of sign and continue with the sign
// at their start.
void turn_with_cosine(QuasiVelocities& q) {
  Graph& g = *q.system.model->graph;
  const Expr c = cos(g.jet(2, 0)), sign = c / sqrt(pow(c, 2));
  const std::size_t first = q.system.size() - q.count;
  const auto turned = [&](const Column& es) {
    return substitute(es, [&](NodeId id) {
      const Node& n = g.node(id);
      return n.kind == Kind::state && n.order == 0 ? Expr{&g, id} * sign : Expr{};
    });
  };
  q.velocities = turned(q.velocities);
  for (Expr& p : q.of_state) p = p * sign;
  Column equations = turned(q.system.equations);
  // p' = f(q, sign p) becomes p' = sign f(q, sign p).
  for (std::size_t i = 0; i < q.count; ++i) {
    const Expr rate = g.state(static_cast<std::uint32_t>(i), 1);
    equations[first + i] = rate - sign * (rate - equations[first + i]);
  }
  q.system.equations = equations;
}

TEST(Poles, VelocitiesDoNotJumpWhereQuasiVelocitiesChangeTheirSign) {
  Scenario prepared;
  ASSERT_TRUE(make_scenario(test::model_of(kForceWithPoles), *find_formulation("routh"), {}, prepared).ok());
  Workspace s(prepared);
  Start<long double> start;
  ASSERT_TRUE(initial_state(s, {}, start).ok());
  const std::vector<double> state(start.state.begin(), start.state.end());
  const auto symbol = [&](const Node& n) {
    return n.kind == Kind::jet && n.order < 2 ? state[2 * n.index + n.order] : 0.0;
  };
  std::string why;
  std::optional<QuasiVelocities> q = quasi_velocities(s.system, *s.mechanics, {}, symbol, why);
  ASSERT_TRUE(q) << why;
  turn_with_cosine(*q);
  Structure first_order;
  first_order.c.assign(q->system.size(), 0);
  first_order.d.assign(q->system.size(), 1);
  const auto in_p = std::make_shared<const Program>(program(q->system, first_order, {}, true));
  const Program p = program(s.system, s.structure);
  for (const int order : {12, 15, 19}) {
    StepSettings settings;
    settings.order = order;
    settings.measure = false;
    Stepper<double> stepper(p, {}, {}, settings);
    stepper.accelerate(
        KernelPlan::make(in_p, std::make_shared<const StateMap>(*q), false, stepper.order() - 1, {}, 0, state));
    ASSERT_TRUE(stepper.start(0, start.state).ok());
    while (stepper.time() < 3) {
      const Outcome o = stepper.step(3);
      ASSERT_TRUE(o.ok()) << o.message;
    }
    EXPECT_GT(stepper.expansions_by_kernel(), 2U);
    EXPECT_NEAR(static_cast<double>(stepper.state()[4]), 2.7859590684232, 1e-10) << "order " << order;
  }
}

}  // namespace
}  // namespace anholon::poles_test
