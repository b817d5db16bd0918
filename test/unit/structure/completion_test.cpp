// The state beyond positions and velocities: given accelerations and multipliers, values that follow, choices,
// branches.
#include <gtest/gtest.h>

#include "structure/branch.h"
#include "structure/consistent.h"
#include "support/models.h"

namespace anholon::completion_test {
namespace {

constexpr double kRoundoff = 1e-14;  // numbers of size one

// A particle of mass 2 in a force field.
std::string text(const std::string& equation, const std::string& initial, const std::string& force = "[0, 0, -6]") {
  return "coordinates = [\"x\", \"y\", \"z\"]\n[[particle]]\nname = \"p\"\nmass = 2\nposition = [\"x\", \"y\", "
         "\"z\"]\n[[force]]\nname = \"f\"\non = \"p\"\n"
         "vector = " +
         force + "\n[[constraint]]\nname = \"c\"\nequation = \"" + equation + "\"\n[initial]\n" + initial;
}

template <class N = double>
Outcome complete(const std::string& model_text, InitialState<N>& state, std::vector<StateOverride> overrides = {}) {
  const auto model = test::model_of(model_text);
  const Mechanics m = mechanics(*model);
  std::vector<std::size_t> all;
  for (std::size_t r = 0; r < m.phi.size(); ++r) all.push_back(r);
  System s = implicit_system(model, m, *find_formulation("routh"), all, {});
  Structure t;
  if (Outcome o = analyse(s, {}, {}, t); !o.ok()) return o;
  drop_absent(s, t);
  const InitialProblem<N> problem{&m, {}, std::move(overrides), std::nullopt};
  if (Outcome o = consistent_state(problem, state); !o.ok()) return o;
  EXPECT_TRUE(needs_completion(m, s, t));
  return complete_state(problem, s, t, state);
}

bool says(const InitialState<double>& s, const std::string& part) {
  for (const std::string& n : s.notes)
    if (n.find(part) != std::string::npos) return true;
  return false;
}

// m x'' = l, m y'' = l z', m z'' = -6: the third derivatives contain l' and the constraint.
const char* const kLinear = "x''' + z'*y''' = x";

TEST(Completion, AccelerationsFollowFromTheMultiplier) {
  InitialState<double> s;
  ASSERT_TRUE(complete(text(kLinear, "\"z'\" = 3\nlambda = {c = 0.4}\n"), s).ok());
  EXPECT_NEAR(s.higher[0].value[0], 0.2, kRoundoff);
  EXPECT_NEAR(s.higher[0].value[1], 0.6, kRoundoff);
  EXPECT_EQ(s.higher[0].origin[0], Origin::derived);
  EXPECT_EQ(s.multipliers[0].origin[0], Origin::given);
  EXPECT_TRUE(s.notes.empty());
  // The leading derivatives: x''' + 3 y''' = 0, 2 x''' = l', 2 y''' = 3 l' + z'' l, z'' = -3.
  EXPECT_NEAR(s.multipliers[1].value[0], 0.36, kRoundoff);
}

TEST(Completion, TheMultiplierFollowsFromAnAcceleration) {
  InitialState<double> s;
  ASSERT_TRUE(complete(text(kLinear, "\"z'\" = 3\nqddot = {y = 0.6}\n"), s).ok());
  EXPECT_NEAR(s.multipliers[0].value[0], 0.4, kRoundoff);
  EXPECT_EQ(s.multipliers[0].origin[0], Origin::derived);
  EXPECT_TRUE(s.notes.empty());
}

TEST(Completion, WithoutEitherTheConstraintDoesNotReactAtTheStartAndThatIsSaid) {
  InitialState<double> s;
  ASSERT_TRUE(complete(text(kLinear, "\"z'\" = 3\n", "[1, 0, -6]"), s).ok());
  EXPECT_EQ(s.multipliers[0].value[0], 0);
  EXPECT_EQ(s.multipliers[0].origin[0], Origin::chosen);
  EXPECT_EQ(s.higher[0].value[0], 0.5);
  EXPECT_TRUE(says(s, "a choice: lambda.c = 0"));
  // The least change starts from the guess: the nearest acceleration to it, in the mass norm, along (1, 3).
  ASSERT_TRUE(complete(text(kLinear, "\"z'\" = 3\nguess = {\"x''\" = 1, \"y''\" = 3}\n", "[0, 0, -6]"), s).ok());
  EXPECT_NEAR(s.multipliers[0].value[0], 2, 1e-10);  // the metric is regularised by 1e-12
}

TEST(Completion, AccelerationsThatNoMultiplierGivesAreRefused) {
  InitialState<double> s;
  const Outcome o = complete(text(kLinear, "\"z'\" = 3\nqddot = {x = 0.2, y = 0.7}\n"), s);
  EXPECT_EQ(o.kind, OutcomeKind::inconsistent);
  EXPECT_NE(o.message.find("equation of motion"), std::string::npos) << o.message;
  // A miss in the ninth digit counts as a rounded number.
  ASSERT_TRUE(complete(text(kLinear, "\"z'\" = 3\nqddot = {x = 0.2, y = 0.600000001}\n"), s).ok());
  EXPECT_EQ(s.higher[0].origin[1], Origin::corrected);
  EXPECT_LT(s.largest_correction, 1e-8);
}

TEST(Completion, WhatIsGivenElsewhereOverridesTheFile) {
  InitialState<double> s;
  ASSERT_TRUE(complete(text(kLinear, "\"z'\" = 3\nlambda = {c = 0.4}\n"), s, {{2, 0, Rational(1, 2)}}).ok());
  EXPECT_NEAR(s.multipliers[0].value[0], 1, kRoundoff);
  ASSERT_TRUE(complete(text(kLinear, "\"z'\" = 3\nqddot = {x = 1}\n"), s, {{0, 0, Rational(1, 2), true}}).ok());
  EXPECT_NEAR(s.higher[0].value[0], 0.25, kRoundoff);
}

TEST(Completion, ManyDigits) {
  const PrecisionScope precision(50);
  InitialState<Multi> s;
  ASSERT_TRUE(complete<Multi>(text(kLinear, "\"z'\" = 3\nlambda = {c = \"1/3\"}\n"), s).ok());
  EXPECT_LE(to_double(abs(Multi(s.higher[0].value[0] - Multi(Rational(1, 6))))), 1e-47);
}

TEST(Completion, HolonomicMultipliersFollowBesideThoseOfOrderThree) {
  InitialState<double> s;
  const std::string plane = "[[constraint]]\nname = \"plane\"\nequation = \"z = x^2\"\n";
  std::string all = text(kLinear, "x = 1\n\"x'\" = 0.5\nlambda = {c = 0.4}\n");
  all.insert(all.find("[initial]"), plane);
  ASSERT_TRUE(complete(all, s).ok());
  // z'' = 2 x'^2 + 2 x x'' and 2 z'' = -6 + mu, 2 x'' = l - 2 x mu: 2 x'' = 0.4 - 2 (7 + 4 x'').
  EXPECT_NEAR(s.higher[0].value[0], -1.36, 1e-13);
  EXPECT_NEAR(s.multipliers[0].value[1], 1.56, 1e-13);
}

TEST(Branches, GaussChoosesWhereNothingIsSaid) {
  InitialState<double> s;
  const std::string sphere = "x''^2 + y''^2 + z''^2 = 25";
  ASSERT_TRUE(complete(text(sphere, ""), s).ok());  // free: z'' = -3
  EXPECT_NEAR(s.higher[0].value[2], -5, 1e-12);
  EXPECT_TRUE(says(s, "several solutions"));
  EXPECT_NEAR(s.multipliers[0].value[0], 0.4, 1e-12);  // -10 + 6 = 2 l z''
}

TEST(Branches, AreNamedByTheSignOfTheMultiplierOrByAGuess) {
  InitialState<double> s;
  const std::string jerk = "x'''^2 + y'''^2 + z'''^2 = 9";
  ASSERT_TRUE(complete(text(jerk, "branch = {c = \"lambda > 0\"}\n"), s).ok());  // R = 2 z'' + 6 = 6
  EXPECT_NEAR(s.higher[1].value[2], 3, 1e-12);
  EXPECT_NEAR(s.multipliers[0].value[0], 1, 1e-12);
  EXPECT_FALSE(says(s, "several solutions"));
  EXPECT_TRUE(says(s, "a choice: x'' = 0, y'' = 0, z'' = 0"));
  ASSERT_TRUE(complete(text(jerk, "branch = {c = \"lambda < 0\"}\n"), s).ok());
  EXPECT_NEAR(s.higher[1].value[2], -3, 1e-12);
  ASSERT_TRUE(complete(text(jerk, "guess = {\"z'''\" = -1}\n"), s).ok());
  EXPECT_NEAR(s.higher[1].value[2], -3, 1e-12) << "the nearest";
  EXPECT_FALSE(says(s, "several solutions"));
}

TEST(Branches, WithoutReactionThereIsNone) {
  InitialState<double> s;
  const Outcome o = complete(text("x'''^2 + y'''^2 + z'''^2 = 9", "qddot = {z = -3}\n"), s);
  EXPECT_EQ(o.kind, OutcomeKind::singular);
  EXPECT_NE(o.message.find("multiplier of the constraint 'c' is 0"), std::string::npos) << o.message;
  EXPECT_NE(o.hint.find("qddot"), std::string::npos);
}

TEST(Branches, ThatDoNotExistAreRefused) {
  InitialState<double> s;
  Outcome o = complete(text("x''^2 + y''^2 + z''^2 = -1", ""), s);
  EXPECT_EQ(o.kind, OutcomeKind::no_convergence) << o.message;
  // The solutions are x''' = 3 and -3; lambda > 0 selects the latter, since 2 lambda x''' = m x'' = -2.
  o = complete(text("x'''^2 = 9", "qddot = {x = -1}\nbranch = {c = \"lambda > 0\"}\n"), s);
  ASSERT_TRUE(o.ok()) << o.message;
  EXPECT_NEAR(s.higher[1].value[0], -3, 1e-12);
}

TEST(Conditions, OnAccelerationsFindVelocities) {
  // A conical pendulum at the height -0.6: v^2 = g (1 - z^2)/(-z), g = 3.
  InitialState<double> s;
  ASSERT_TRUE(complete(text("x^2 + y^2 + z^2 = 1",
                            "y = 0\nz = -0.6\nguess = {x = 1, \"y'\" = 2}\n\"z'\" = 0\nconditions = [\"z'' = 0\"]\n"),
                       s)
                  .ok());
  EXPECT_NEAR(s.q[0], 0.8, kRoundoff);
  EXPECT_NEAR(s.qd[1] * s.qd[1], 3 * 0.64 / 0.6, 1e-12);
  EXPECT_EQ(s.qd_origin[1], Origin::derived);
}

TEST(Conditions, OnMultipliersFindVelocitiesOrElsePositions) {
  InitialState<double> s;
  const std::string sphere = "x^2 + y^2 + z^2 = 1";
  // At the lowest point 2 z'' = -6 - 2 l and z'' = v^2: the multiplier is -3 - v^2.
  ASSERT_TRUE(
      complete(
          text(sphere, "x = 0\ny = 0\nz = -1\n\"y'\" = 0\nguess = {\"x'\" = 1}\nconditions = [\"lambda.c = -5\"]\n"), s)
          .ok());
  EXPECT_NEAR(s.qd[0] * s.qd[0], 2, 1e-11);
  // The system is at rest; the position is the one at which z'' has the given value.
  ASSERT_TRUE(
      complete(
          text(sphere,
               "y = 0\nqdot = {x = 0, y = 0, z = 0}\nguess = {x = 0.8, z = -0.5}\nconditions = [\"z'' = -3/2\"]\n"),
          s)
          .ok());
  EXPECT_NEAR(s.q[0] * s.q[0], 0.5, 1e-12);  // z'' = -3 x^2
  EXPECT_EQ(s.q_origin[0], Origin::derived);
}

TEST(Conditions, ThatCannotHoldAreNamed) {
  InitialState<double> s;
  const Outcome o =
      complete(text("x' = y", "x = 0\ny = 0\nz = 0\nqdot = {y = 0, z = 0}\nconditions = [\"z'' = 1\"]\n"), s);
  EXPECT_EQ(o.kind, OutcomeKind::inconsistent);
}

// Accelerations, velocities or positions of coordinates without inertia follow from the state, so conditions on them
// are conditions on the state.
std::string massless(const std::string& elements, const std::string& initial) {
  return "coordinates = [\"x\", \"y\"]\nparticle = [{name = \"p\", mass = 1, position = \"x*ex\"}]\n" + elements +
         "\ninitial = {" + initial + "}\n";
}

TEST(Completion, ConditionsOnTheAccelerationOfAWheelWithoutInertia) {
  const char* const wheel = "force = [{on = \"p\", vector = \"(2 - x')*ex\"}]\n"
                            "constraint = [{name = \"gear\", equation = \"y' = 3*x'\"}]\n";
  InitialState<double> rest, moves;
  ASSERT_TRUE(complete(massless(wheel, "conditions = [\"y'' = 0\"]"), rest).ok());
  EXPECT_NEAR(rest.qd[0], 2, kRoundoff);
  EXPECT_NEAR(rest.qd[1], 6, 4 * kRoundoff);
  ASSERT_TRUE(complete(massless(wheel, "conditions = [\"y'' = 1\"]"), moves).ok());
  EXPECT_NEAR(moves.qd[0], 5.0 / 3, kRoundoff);
}

TEST(Completion, ConditionsOnThePositionOfANodeWithoutInertia) {
  const char* const spring = "potential.k = \"(x - y)^2/2 + y^2/2\"\n";
  InitialState<double> position, velocity, damped, slower;
  ASSERT_TRUE(complete(massless(spring, "conditions = [\"y = 1\"]"), position).ok());
  EXPECT_NEAR(position.q[0], 2, kRoundoff);
  EXPECT_NEAR(position.q[1], 1, kRoundoff);
  ASSERT_TRUE(complete(massless(spring, "conditions = [\"y' = 1\"]"), velocity).ok());
  EXPECT_NEAR(velocity.qd[0], 2, kRoundoff);
  EXPECT_NEAR(velocity.qd[1], 1, kRoundoff);
  // With a damper, y' = x - 2 y.
  const std::string damper = std::string(spring) + "dissipation.d = \"y'^2/2\"\n";
  ASSERT_TRUE(complete(massless(damper, "x = 1, conditions = [\"y' = 0\"]"), damped).ok());
  EXPECT_NEAR(damped.q[1], 0.5, kRoundoff);
  // y'' = x' - 2 y' = 0
  ASSERT_TRUE(complete(massless(damper, "x = 1, \"x'\" = 0.6, conditions = [\"y'' = 0\"]"), slower).ok());
  EXPECT_NEAR(slower.qd[1], 0.3, kRoundoff);
  EXPECT_NEAR(slower.q[1], 0.35, kRoundoff);
}

TEST(Completion, ConditionsBeyondAccelerations) {
  InitialState<double> s;  // x''' = -x' - 2 x' x'' = 1 with x'' = 1/2
  ASSERT_TRUE(complete("coordinates = [\"x\"]\nparticle = [{name = \"p\", mass = 1, position = \"x*ex\"}]\n"
                       "force = [{on = \"p\", vector = \"(2 - x - x'^2)*ex\"}]\n"
                       "initial = {conditions = [\"x''' = 1\", \"x'' = 0.5\"]}\n",
                       s)
                  .ok());
  EXPECT_NEAR(s.qd[0], -0.5, kRoundoff);
  EXPECT_NEAR(s.q[0], 1.25, 2 * kRoundoff);
}

}  // namespace
}  // namespace anholon::completion_test
