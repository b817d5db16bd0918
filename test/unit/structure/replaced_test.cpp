// Values of options in place of values of the file: those that clash give way, with a note; all others stay or clash.
#include <gtest/gtest.h>

#include "structure/consistent.h"
#include "support/models.h"

namespace anholon::replaced_test {
namespace {

constexpr double kRoundoff = 1e-15;

template <class N = double>
Outcome solve(const std::string& model_text, InitialState<N>& state, std::vector<StateOverride> overrides = {}) {
  const auto model = test::model_of(model_text);
  const Mechanics m = mechanics(*model);
  const InitialProblem<N> problem{&m, {}, std::move(overrides), std::nullopt};
  return consistent_state(problem, state);
}

// A sledge whose blade stands at a distance in front of its centre of mass.
std::string sledge(const std::string& turning) {
  return "coordinates = [\"x\", \"y\", \"p\"]\n"
         "body = [{name = \"b\", mass = 1, inertia = 0.2, center = \"x*ex + y*ey\", angle = \"p\"}]\n"
         "constraint = [{name = \"blade\", equation = \"dot(vel(b, b.center + 0.2*b.x), b.y) = 0\"}]\n"
         "initial = {x = 0.3, \"x'\" = 0.4, \"y'\" = 0.3, \"p'\" = " +
         turning + "}\n";
}

TEST(ReplacedByOptions, ValuesThatClashAmongThemselvesRemainAnError) {
  InitialState<double> s;
  const Outcome alone = solve(sledge("0.6"), s);
  ASSERT_EQ(alone.kind, OutcomeKind::inconsistent);
  for (const StateOverride& unrelated : {StateOverride{0, 0, Rational(3, 10)}, StateOverride{0, 0, Rational(5)},
                                         StateOverride{1, 0, Rational(2, 5)}, StateOverride{1, 0, Rational(7)}}) {
    const Outcome o = solve(sledge("0.6"), s, {unrelated});
    EXPECT_EQ(o.kind, OutcomeKind::inconsistent);
    EXPECT_EQ(o.message, alone.message);
  }
  const PrecisionScope precision(40);
  InitialState<Multi> wide;
  EXPECT_EQ(solve<Multi>(sledge("0.6"), wide, {{0, 0, Rational(3, 10)}}).kind, OutcomeKind::inconsistent);
}

TEST(ReplacedByOptions, ValuesThatClashWithAnOptionGiveWayAndAreNamed) {
  InitialState<double> s;
  ASSERT_TRUE(solve(sledge("0.6"), s, {{1, 1, Rational(3, 10)}}).ok());
  EXPECT_EQ(s.qd[0], 0.4);  // it does not take part: the blade does not feel it at p = 0
  EXPECT_EQ(s.qd_origin[0], Origin::given);
  EXPECT_EQ(s.qd[1], 0.3);
  EXPECT_NEAR(s.qd[2], -1.5, 2 * kRoundoff);
  EXPECT_EQ(s.replaced.note, "initial data of the file clash with y' = 0.3 and give way: p' = 0.6 is replaced by -1.5");
  ASSERT_EQ(s.notes.size(), 1U);
  EXPECT_EQ(s.notes[0], s.replaced.note);

  // Another angle: all velocities take part, and change as little as the kinetic energy of their change allows.
  InitialState<double> turned;
  ASSERT_TRUE(solve(sledge("-1.5"), turned, {{0, 2, Rational(1, 5)}}).ok());
  EXPECT_EQ(turned.q[0], 0.3);
  const double normal[] = {-std::sin(0.2), std::cos(0.2), 0.2}, mass[] = {1, 1, 0.2}, before[] = {0.4, 0.3, -1.5};
  double miss = 0, size = 0;
  for (int a = 0; a < 3; ++a) miss += normal[a] * before[a], size += normal[a] * normal[a] / mass[a];
  for (std::size_t a = 0; a < 3; ++a)
    EXPECT_NEAR(turned.qd[a], before[a] - miss / size * normal[a] / mass[a], 1e-11) << a;
  EXPECT_NE(turned.replaced.note.find("p = 0.2 and give way: x' = 0.4 is replaced by 0.385853, y' = 0.3 by 0.369787, "
                                      "p' = -1.5 by -1.42879"),
            std::string::npos)
      << turned.replaced.note;

  // An option that fits replaces nothing.
  InitialState<double> fits;
  ASSERT_TRUE(solve(sledge("-1.5"), fits, {{0, 0, Rational(7)}}).ok());
  EXPECT_TRUE(fits.replaced.note.empty());
  EXPECT_TRUE(fits.notes.empty());
}

// Two sledges: the option concerns one of them.
TEST(ReplacedByOptions, ValuesOfOtherConstraintsStay) {
  const std::string text =
      "coordinates = [\"x\", \"y\", \"u\", \"v\"]\n"
      "particle = [{name = \"a\", mass = 1, position = [\"x\", \"y\", \"0\"]}, {name = \"b\", mass = 1, position = "
      "[\"u\", \"v\", \"0\"]}]\n"
      "constraint = [{name = \"first\", equation = \"y' = x*x'\"}, {name = \"second\", equation = \"v' = u*u'\"}]\n"
      "initial = {x = 1, \"x'\" = 2, \"y'\" = 2, u = 1, \"u'\" = 3, \"v'\" = 3}\n";
  InitialState<double> s;
  ASSERT_TRUE(solve(text, s, {{0, 0, Rational(2)}}).ok());
  EXPECT_EQ(s.qd[2], 3);
  EXPECT_EQ(s.qd[3], 3);
  EXPECT_EQ(s.qd_origin[3], Origin::given);
  EXPECT_NEAR(s.qd[1], 2 * s.qd[0], 4 * kRoundoff);
  // The mutant: the second clashes by itself.
  std::string clash = text;
  clash.replace(clash.find("\"v'\" = 3"), 8, "\"v'\" = 4");
  EXPECT_EQ(solve(clash, s, {{0, 0, Rational(2)}}).kind, OutcomeKind::inconsistent);
}

// All contradictions are released together: a disc goes on rolling if its heading changes. With y' = 0 kept, it would
// stop.
TEST(ReplacedByOptions, ARollingDiscWithAnotherHeadingGoesOnRolling) {
  const std::string text = "coordinates = [\"x\", \"y\", \"h\", \"r\"]\n"
                           "particle = [{name = \"a\", mass = 1, position = [\"x\", \"y\", \"r/2\"]}]\n"
                           "constraint = [{name = \"a1\", equation = \"x' = r'*cos(h)\"}, {name = \"a2\", equation = "
                           "\"y' = r'*sin(h)\"}]\n"
                           "initial = {\"x'\" = 1, \"y'\" = 0, \"r'\" = 1, \"h'\" = 0.3}\n";
  InitialState<double> s;
  ASSERT_TRUE(solve(text, s, {{0, 2, Rational(1)}}).ok());
  EXPECT_GT(s.qd[3], 0.4);
  EXPECT_NEAR(s.qd[0], s.qd[3] * std::cos(1.0), 1e-12);
  EXPECT_EQ(s.qd[2], 0.3);
}

TEST(ReplacedByOptions, PositionsGiveWayTogether) {
  const std::string text = "coordinates = [\"x\", \"y\", \"r\", \"a\", \"w\"]\n"
                           "particle = [{name = \"p\", mass = 1, position = [\"x\", \"y\", \"r + w\"]}]\n"
                           "constraint = [{name = \"c1\", equation = \"x = r*cos(a)\"}, {name = \"c2\", equation = "
                           "\"y = r*sin(a)\"}]\n"
                           "initial = {x = 1, y = 0, r = 1, w = 2}\n";
  InitialState<double> s;
  ASSERT_TRUE(solve(text, s, {{0, 3, Rational(3, 10)}}).ok());
  EXPECT_GT(s.q[2], 0.7);
  EXPECT_NEAR(s.q[0], s.q[2] * std::cos(0.3), 1e-12);
  EXPECT_EQ(s.q[4], 2);
  EXPECT_EQ(s.replaced.values.size(), 3U);
}

TEST(ReplacedByOptions, AConditionOnTheOptionGivesWay) {
  const std::string text = "coordinates = [\"x\", \"y\"]\n"
                           "particle = [{name = \"p\", mass = 1, position = [\"x\", \"y\", \"0\"]}]\n"
                           "constraint = [{name = \"c\", equation = \"x' = 2*y'\"}]\n"
                           "initial.conditions = [\"y' = 2\"]\n";
  InitialState<double> s;
  ASSERT_TRUE(solve(text, s, {{1, 1, Rational(3)}}).ok());
  EXPECT_NEAR(s.qd[0], 6, 6 * kRoundoff);
  EXPECT_TRUE(s.replaced.note.empty()) << s.replaced.note;
}

}  // namespace
}  // namespace anholon::replaced_test
