// Consistent initial data: given values hold, missing ones follow by least change, rounded ones are corrected,
// contradictions are named.
#include <gtest/gtest.h>

#include "structure/consistent.h"
#include "structure/start_memory.h"
#include "support/models.h"

namespace anholon::consistent_test {
namespace {

// A particle of mass m in the plane and one of mass M on a line.
std::string text(const std::string& constraints, const std::string& initial) {
  return "coordinates = [\"x\", \"y\"]\n[parameters]\nmx = 1\nmy = 4\n[[particle]]\nname = \"a\"\nmass = "
         "\"mx\"\nposition = \"x*ex\"\n[[particle]]\nname = "
         "\"b\"\nmass = \"my\"\nposition = \"y*ey\"\n" +
         constraints + "[initial]\n" + initial;
}
std::string constraint(const std::string& equation) {
  return "[[constraint]]\nname = \"c\"\nequation = \"" + equation + "\"\n";
}

template <class N = double>
Outcome solve(const std::string& model_text, InitialState<N>& state, std::vector<StateOverride> overrides = {}) {
  const auto model = test::model_of(model_text);
  const Mechanics m = mechanics(*model);
  Column values;
  for (const Parameter& p : model->parameters) values.push_back(p.value);
  const InitialProblem<N> problem{&m, evaluate_parameters<N>(*model->graph, values), std::move(overrides),
                                  std::nullopt};
  return consistent_state(problem, state);
}

constexpr double kRoundoff = 1e-15;  // coordinates of size one

TEST(ConsistentState, MissingVelocitiesFollowFromTheConstraint) {
  InitialState<double> s;
  ASSERT_TRUE(solve(text(constraint("x' = 3*y' + 1"), "x = 0\ny = 0\n\"y'\" = 2\n"), s).ok());
  EXPECT_NEAR(s.qd[0], 7, 7 * kRoundoff);
  EXPECT_EQ(s.qd[1], 2);
  EXPECT_EQ(s.qd_origin[0], Origin::derived);
  EXPECT_EQ(s.qd_origin[1], Origin::given);
}

TEST(ConsistentState, VelocitiesThatAreNotDeterminedAreChosen) {
  InitialState<double> s;
  ASSERT_TRUE(solve(text(constraint("x' = 3*y' + 1"), "x = 0\ny = 0\n"), s).ok());
  EXPECT_EQ(s.qd_origin[0], Origin::chosen);
  EXPECT_EQ(s.qd_origin[1], Origin::chosen);
  ASSERT_EQ(s.notes.size(), 1U);
  EXPECT_NE(s.notes[0].find("the least change that satisfies the constraints: other values in [initial]"),
            std::string::npos);

  InitialState<double> one;  // y' alone is determined
  ASSERT_TRUE(solve(text(constraint("2*y' = 6"), "x = 0\ny = 0\n"), one).ok());
  EXPECT_EQ(one.qd_origin[0], Origin::chosen);
  EXPECT_EQ(one.qd_origin[1], Origin::derived);
  EXPECT_TRUE(one.notes.empty());
}

TEST(ConsistentState, WhatIsFreeChangesLeastInTheMassNorm) {
  // min x'^2 + 4 y'^2 with x' + y' = 5: x' = 4, y' = 1.
  InitialState<double> s;
  ASSERT_TRUE(solve(text(constraint("x' + y' = 5"), "x = 0\ny = 0\n"), s).ok());
  EXPECT_NEAR(s.qd[0], 4, 1e-11);  // the metric is regularised by 1e-12
  EXPECT_NEAR(s.qd[1], 1, 1e-11);
  // The mutant, least change in the Euclidean norm, is (2.5, 2.5). With a guess the change is measured from the guess.
  ASSERT_TRUE(solve(text(constraint("x' + y' = 5"), "x = 0\ny = 0\nguess = {\"x'\" = 10, \"y'\" = 0}\n"), s).ok());
  EXPECT_NEAR(s.qd[0], 6, 1e-11);
  EXPECT_NEAR(s.qd[1], -1, 1e-11);
}

TEST(ConsistentState, PositionsComeFirstThenTheDerivedConstraint) {
  InitialState<double> s;
  ASSERT_TRUE(solve(text(constraint("x^2 + y^2 = 25"), "x = 3\nguess = {y = 1}\n\"x'\" = 4\n"), s).ok());
  EXPECT_NEAR(s.q[1], 4, 4 * kRoundoff);
  EXPECT_NEAR(s.qd[1], -3, 8 * kRoundoff);  // x x' + y y' = 0
}

// y' = x' sin(y - 3/10): if x' is given, y' = 0 determines y.
TEST(ConsistentState, ConditionsOnVelocitiesMovePositions) {
  const std::string law = constraint("y' = x'*sin(y - 0.3)"), moving = "\"x'\" = 1\nconditions = [\"y' = 0\"]\n";
  InitialState<double> s;
  ASSERT_TRUE(solve(text(law, "x = 0\n" + moving), s).ok());
  EXPECT_NEAR(s.q[1], 0.3, kRoundoff);
  EXPECT_EQ(s.q_origin[1], Origin::derived);
  EXPECT_EQ(s.q[0], 0);
  EXPECT_EQ(s.qd[0], 1);
  EXPECT_NEAR(s.qd[1], 0, kRoundoff);
  // Positions stay if velocities can satisfy the condition.
  ASSERT_TRUE(solve(text(law, "conditions = [\"y' = x' - 1\"]\n"), s).ok());
  EXPECT_EQ(s.q[1], 0);
  // A position at infinity is no solution.
  EXPECT_FALSE(solve(text(constraint("y' = x'*exp(-y)"), "x = 0\n" + moving), s).ok());
  // A given position stays.
  EXPECT_FALSE(solve(text(law, "y = 0.5\n" + moving), s).ok());
  // The values of a command have the same effect.
  ASSERT_TRUE(solve(text(law, "conditions = [\"y' = 0\"]\n"), s, {{1, 0, 2}}).ok());
  EXPECT_NEAR(s.q[1], 0.3, kRoundoff);
}

TEST(ConsistentState, TheGuessNamesTheBranch) {
  InitialState<double> s;
  ASSERT_TRUE(solve(text(constraint("x^2 + y^2 = 25"), "x = 3\nguess = {y = -1}\n\"x'\" = 0\n"), s).ok());
  EXPECT_NEAR(s.q[1], -4, 4 * kRoundoff);
}

TEST(ConsistentState, AFlatGuessIsLeft) {
  InitialState<double> s;
  const Outcome o = solve(text(constraint("x^2 + y^2 = 25"), ""), s);
  ASSERT_TRUE(o.ok()) << "the centre of the circle is no dead end: " << o.message << "; reached " << s.q[0] << ", "
                      << s.q[1];
  EXPECT_NEAR(s.q[0] * s.q[0] + s.q[1] * s.q[1], 25, 25 * 4 * kRoundoff);
}

TEST(ConsistentState, RoundedNumbersAreCorrected) {
  InitialState<double> s;
  ASSERT_TRUE(solve(text(constraint("x^2 + y^2 = 1"), "x = 0.6000000001\ny = 0.8\n\"x'\" = 0\n\"y'\" = 0\n"), s).ok());
  EXPECT_NEAR(s.q[0] * s.q[0] + s.q[1] * s.q[1], 1, 4 * kRoundoff);
  EXPECT_EQ(s.q_origin[0], Origin::corrected);
  EXPECT_GT(s.largest_correction, 1e-12);
  EXPECT_LT(s.largest_correction, 2e-10);
}

TEST(ConsistentState, ExactlyGivenValuesStayAsTheyAre) {
  InitialState<double> s;
  ASSERT_TRUE(solve(text(constraint("x^2 + y^2 = 1"), "x = 0.6\ny = 0.8\n\"x'\" = 0\n\"y'\" = 0\n"), s).ok());
  EXPECT_EQ(s.q[0], 0.6);
  EXPECT_EQ(s.q[1], 0.8);
  EXPECT_EQ(s.q_origin[0], Origin::given);
}

TEST(ConsistentState, ValuesThatClashAreNamed) {
  InitialState<double> s;
  const Outcome o = solve(text(constraint("x^2 + y^2 = 1"), "x = 0.6\ny = 0.9\n"), s);
  EXPECT_EQ(o.kind, OutcomeKind::inconsistent);
  EXPECT_NE(o.message.find("constraint 'c'"), std::string::npos) << o.message;
  EXPECT_NE(o.hint.find("x, y"), std::string::npos) << o.hint;
}

// The cosine of a right angle is round-off in any precision: x' follows from the constraint alone, and y' does not
// follow from it.
TEST(ConsistentState, CoefficientsThatAreRoundOffDetermineNothing) {
  const auto blade = [](auto number, const std::string& equation, const std::string& velocity) {
    InitialState<decltype(number)> s;
    std::string model = text(constraint(equation), "x = 0\ny = 0\n" + velocity);
    model.replace(model.find("my = 4"), 6, "my = 4\nth = \"pi/2\"\nsmall = 1e-20");
    const Outcome o = solve(model, s);
    return std::pair(o, s);
  };
  const std::string equation = "cos(th)*y' = sin(th)*x'", given = "\"x'\" = -0.5\n";
  EXPECT_EQ(blade(1.0, equation, given).first.kind, OutcomeKind::inconsistent);
  EXPECT_EQ(blade(1.0L, equation, given).first.kind, OutcomeKind::inconsistent);
  const auto [outcome, state] = blade(1.0, equation, "\"y'\" = 2\n");
  ASSERT_TRUE(outcome.ok());
  EXPECT_EQ(state.qd[1], 2);
  EXPECT_NEAR(state.qd[0], 0, kRoundoff);
  // The mutant: a coefficient that is small, but no round-off.
  const auto [of_small, far] = blade(1.0, "small*y' = x'", given);
  ASSERT_TRUE(of_small.ok());
  EXPECT_NEAR(far.qd[1], -0.5e20, 1e6);
}

TEST(ConsistentState, ConditionsAreMet) {
  InitialState<double> s;
  ASSERT_TRUE(
      solve(text(constraint("x' = y'"), "x = 0\nconditions = [\"y^2 = 2\", \"x' + y' = 6\"]\nguess = {y = 1}\n"), s)
          .ok());
  EXPECT_NEAR(s.q[1], std::sqrt(2.0), 4 * kRoundoff);
  EXPECT_NEAR(s.qd[0], 3, 1e-14);
}

TEST(ConsistentState, NoRealSolutionIsInconsistent) {
  InitialState<double> s;
  EXPECT_EQ(solve(text(constraint("x^2 + y^2 = -1"), ""), s).kind, OutcomeKind::inconsistent);
  EXPECT_EQ(solve(text(constraint("sqrt(x - 5) = 1"), "x = 0\n"), s).kind, OutcomeKind::inconsistent);
}

TEST(ConsistentState, OverridesReplaceTheModelsValues) {
  InitialState<double> s;
  ASSERT_TRUE(
      solve(text(constraint("x' = 3*y'"), "x = 1\n\"y'\" = 1\n"), s, {{1, 1, Rational(2)}, {0, 0, Rational(7, 2)}})
          .ok());
  EXPECT_EQ(s.q[0], 3.5);
  EXPECT_NEAR(s.qd[0], 6, 6 * kRoundoff);
}

TEST(ConsistentState, HoldsInAnyPrecision) {
  const PrecisionScope precision(50);
  InitialState<Multi> s;
  ASSERT_TRUE(solve<Multi>(text(constraint("x^2 + y^2 = 5"), "x = 1\nguess = {y = 1.9}\n\"x'\" = 0.1\n"), s).ok());
  EXPECT_LE(to_double(abs(Multi(s.q[1] - Multi(2)))), 1e-47);
  EXPECT_LE(to_double(abs(Multi(s.qd[1] + Multi(Rational(1, 20))))), 1e-47);
}

// States are computed one after the other with a memory, and each by itself.
struct MemoryCase {
  const char *constraint, *initial;
  std::vector<std::vector<StateOverride>> starts;
};

void same_with_memory(const MemoryCase& c) {
  using N = long double;
  const auto model = test::model_of(text(constraint(c.constraint), c.initial));
  const Mechanics m = mechanics(*model);
  Column values;
  for (const Parameter& p : model->parameters) values.push_back(p.value);
  const std::vector<N> parameters = evaluate_parameters<N>(*model->graph, values);
  const StartPlan plan(m);
  StartMemory<N> memory(m, plan, parameters);
  std::vector<N> heavier = parameters;
  heavier[0] *= 2;
  StartMemory<N> mutant(m, plan, heavier);
  bool differs = false;
  for (const std::vector<StateOverride>& overrides : c.starts) {
    InitialProblem<N> problem{&m, parameters, overrides, std::nullopt};
    problem.plan = &plan;
    InitialState<N> alone, kept, wrong;
    const Outcome a = consistent_state(problem, alone), b = consistent_state(problem, memory, kept);
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.message, b.message);
    EXPECT_EQ(alone.q, kept.q);
    EXPECT_EQ(alone.qd, kept.qd);
    EXPECT_EQ(alone.q_origin, kept.q_origin);
    EXPECT_EQ(alone.qd_origin, kept.qd_origin);
    EXPECT_EQ(alone.largest_correction, kept.largest_correction);
    static_cast<void>(consistent_state(problem, mutant, wrong));
    differs = differs || wrong.qd != alone.qd;
  }
  EXPECT_TRUE(differs) << "the mutant: a memory for other parameters";
}

// All terms of the constraint are as small as the round-off of y', which is a double.
TEST(ConsistentState, RoundOffOfDoublesIsNoClash) {
  const auto found = [](const std::string& y) {
    InitialState<long double> s;
    return solve<long double>(
        text(constraint("x*x' + y*y' = 0"), "x = 0.6828\ny = " + y + "\n\"x'\" = 2.4e-17\n\"y'\" = 0.2764\n"), s);
  };
  EXPECT_TRUE(found("-6.7e-17").ok());
  // The mutant: y is off by a thousand round-offs.
  EXPECT_EQ(found("-6.7e-14").kind, OutcomeKind::inconsistent);
}

// Conditions that follow from each other, given with 16 decimal digits, agree to these digits, also in wider numbers.
TEST(ConsistentState, DecimalsThatOverlapAreNoClash) {
  const auto found = [](const std::string& sum) {
    InitialState<long double> s;
    return solve<long double>(text(constraint("y' = x'*sin(x)"), "x = 0.8680870319124994\nconditions = [\"x'*exp(x) = "
                                                                 "-0.6775629798952102\", \"y'*cos(x) = "
                                                                 "-0.1402645951958176\", \"x' + y' = " +
                                                                     sum + "\"]\n"),
                              s);
  };
  EXPECT_TRUE(found("-0.5014408728012463").ok()) << found("-0.5014408728012463").message;
  // The mutant: the last digit but two is changed.
  EXPECT_EQ(found("-0.5014408728019463").kind, OutcomeKind::inconsistent);
}

TEST(ConsistentState, AMemoryLeavesTheBits) {
  const auto x = [](int number, int by) { return StateOverride{0, 0, Rational(number, by)}; };
  const auto rate = [](std::size_t of, int number, int by) { return StateOverride{1, of, Rational(number, by)}; };
  // The rates follow from one linear constraint by least change; a condition is replaced by the override of its rate.
  same_with_memory({"x' + sin(x)*y' = 5",
                    "x = 0.5\ny = 0\nguess = {\"x'\" = 1}\n",
                    {{x(1, 2)}, {x(1, 2)}, {x(1, 3)}, {x(0, 1)}, {x(-1, 7)}, {x(1, 2)}}});
  same_with_memory({"x' + sin(x)*y'*mx = 5",
                    "x = 0.5\ny = 0\nconditions = [\"y' = 2\"]\n",
                    {{rate(1, 2, 1)}, {rate(1, 7, 3)}, {rate(1, 0, 1)}, {rate(1, 7, 3)}, {rate(1, 2, 1)}}});
  // Positions are iterated as well; no point of the circle has x = 6.
  same_with_memory({"x^2 + mx*y^2 = 25",
                    "x = 3\nguess = {y = 1}\n\"x'\" = 4\n",
                    {{x(3, 1)}, {x(4, 1)}, {x(6, 1)}, {x(3, 1)}, {x(-3, 1)}, {x(3, 1)}}});
}

// Given values that are rounded numbers are corrected, and unknowns in no constraint stay at their guess.
TEST(ConsistentState, CorrectedValuesLeaveTheOthersAtTheirGuess) {
  const auto particle = [](const std::string& equation, const std::string& initial) {
    return "coordinates = [\"x\", \"y\", \"z\"]\n[[particle]]\nname = \"p\"\nmass = 2\nposition = [\"x\", \"y\", "
           "\"z\"]\n" +
           constraint(equation) + "[initial]\n" + initial;
  };
  InitialState<double> s;
  ASSERT_TRUE(solve(particle("x = y", "x = 0.7\ny = 0.700000001\n"), s).ok());
  EXPECT_EQ(s.q[2], 0);
  EXPECT_EQ(s.q_origin[2], Origin::chosen);
  EXPECT_EQ(s.q_origin[0], Origin::corrected);
  EXPECT_EQ(s.q[0], s.q[1]);

  // The free unknown is at a stationary point of the constraint, at which its value is right.
  InitialState<double> circle;
  ASSERT_TRUE(solve(particle("x^2 + y^2 = 1", "x = 1.000000001\nguess = {z = 3}\n"), circle).ok());
  EXPECT_NEAR(circle.q[0], 1, kRoundoff);
  EXPECT_NEAR(circle.q[1], 0, 1e-8);  // a double root
  EXPECT_EQ(circle.q[2], 3);

  // In a wider type, 16 digits are rounded numbers.
  InitialState<long double> velocities;
  ASSERT_TRUE(
      solve(particle("x'*cos(z) = y'*sin(z)", "z = 0.3\n\"x'\" = 0.2955202066613395\n\"y'\" = 0.955336489125606\n"),
            velocities)
          .ok());
  EXPECT_EQ(velocities.qd[2], 0);
  InitialState<long double> unit;
  ASSERT_TRUE(solve(particle("x^2 + y^2 = 1", "x = 0.2955202066613395\ny = 0.955336489125606\n"), unit).ok());
  EXPECT_EQ(unit.q[2], 0);

  // A value that follows from rounded values does not pull them towards its guess.
  InitialState<double> wheel;
  ASSERT_TRUE(solve(particle("y = 2*x", "x = 0.35\ny = 0.700000001\n") +
                        "[[constraint]]\nname = \"wheel\"\nequation = \"z = 3*x + y\"\n",
                    wheel)
                  .ok());
  EXPECT_NEAR(wheel.q[0], 0.35, 2e-9);
  EXPECT_NEAR(wheel.q[2], 1.75, 1e-8);

  // A search that begins at the centre of a circle changes only the unknowns of the circle.
  InitialState<double> centre;
  ASSERT_TRUE(solve(particle("x^2 + y^2 = 1", ""), centre).ok());
  EXPECT_NEAR(centre.q[0] * centre.q[0] + centre.q[1] * centre.q[1], 1, 4 * kRoundoff);
  EXPECT_EQ(centre.q[2], 0);
}

// A trailer without mass that does not turn is in line with its sleigh; x, y and the direction stay at 0.
TEST(ConsistentState, NothingMovesThatNeedNot) {
  InitialState<double> s;
  ASSERT_TRUE(
      solve("coordinates = [\"x\", \"y\", \"th\", \"c\"]\n"
            "body = [{name = \"s\", mass = 1, inertia = 0.5, center = \"x*ex + y*ey\", angle = \"th\"}]\n"
            "frame.tr = \"rotz(th + c)\"\n"
            "constraint = [{name = \"e\", equation = \"y'*cos(th) - x'*sin(th) = 0\"}, {name = \"f\", equation = "
            "\"dot(vel(s.center - tr.x), tr.y) = 0\"}]\n"
            "initial = {conditions = [\"c' = 0\", \"dot(vel(s.center), s.x) = 1\", \"th' = 0\"], guess = {c = "
            "0.3}}\n",
            s)
          .ok());
  for (std::size_t a = 0; a < 3; ++a) EXPECT_EQ(s.q[a], 0) << a;
  EXPECT_NEAR(s.q[3], 0, kRoundoff);
  EXPECT_NEAR(s.qd[0], 1, kRoundoff);
}

// The shape of a chain between two hooks that is nearest to a guess which misses both hooks: a descent finds it from
// there, Newton's method does not. The values solve M (z - guess) = A^T mu and the constraints (theory: initial-data);
// mpmath found them with the mass matrix written by hand.
template <class N>
InitialState<N> chain_between_hooks() {
  InitialState<N> s;
  EXPECT_TRUE(
      solve<N>("coordinates = [\"th[i]\"]\nindex.n = 4\nindex.i = \"1..n\"\n[parameters]\nl = \"1/n\"\nm = \"1/n\"\n"
               "[point]\n\"P[0]\" = \"0\"\n\"P[i]\" = \"P[i-1] + l*(cos(th[i])*ex + sin(th[i])*ey)\"\n"
               "[[body]]\nname = \"link[i]\"\nmass = \"m\"\ninertia = \"m*l^2/12\"\ncenter = \"(P[i-1] + "
               "P[i])/2\"\nangle = \"th[i]\"\n[[constraint]]\nname = \"hook\"\nequation = \"P[n] = 0.6*ex\"\n"
               "[initial]\nguess = {\"th[i]\" = \"-1.2 + 2.4*(i - 1/2)/n + 0.3*sin(2*pi*i/n)\"}\n",
               s)
          .ok());
  return s;
}

TEST(ConsistentState, TheNearestOfManySolutionsIsFoundInEveryNumberType) {
  constexpr double kMetric = 1e-11;  // of the term 1e-12 that is added to the mass matrix
  const double nearest[] = {-0.54612046519630899667, -0.29551283933196027283, -0.1035201490844144212,
                            1.9886999402759545819};
  const InitialState<double> s = chain_between_hooks<double>();
  const InitialState<long double> wide = chain_between_hooks<long double>();
  const InitialState<Quad> quad = chain_between_hooks<Quad>();
  for (std::size_t a = 0; a < 4; ++a) {
    EXPECT_NEAR(s.q[a], nearest[a], kMetric);
    EXPECT_NEAR(s.q[a], to_double(wide.q[a]), 4 * kRoundoff);
    EXPECT_NEAR(s.q[a], to_double(quad.q[a]), 4 * kRoundoff);
  }
}

}  // namespace
}  // namespace anholon::consistent_test
