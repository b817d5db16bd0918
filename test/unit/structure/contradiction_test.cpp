// Contradictory initial data: the named set is contradictory, and no part of it is.
#include <random>

#include <gtest/gtest.h>

#include "structure/consistent.h"
#include "structure/contradiction.h"
#include "support/models.h"

namespace anholon::contradiction_test {
namespace {

// Particles of mass 1 on lines, one for each coordinate, with these constraints c1, c2, ….
std::string text(const std::vector<std::string>& coordinates, const std::vector<std::string>& equations,
                 const std::string& initial) {
  std::string out = "coordinates = [";
  for (const std::string& q : coordinates) out += "\"" + q + "\", ";
  out += "]\n";
  for (const std::string& q : coordinates)
    out += "[[particle]]\nname = \"p_" + q + "\"\nmass = 1\nposition = \"" + q + "*ex\"\n";
  for (std::size_t k = 0; k < equations.size(); ++k)
    out += "[[constraint]]\nname = \"c" + std::to_string(k + 1) + "\"\nequation = \"" + equations[k] + "\"\n";
  return out + "[initial]\n" + initial;
}

Outcome solve(const std::string& model_text, std::vector<StateOverride> overrides = {}) {
  const auto model = test::model_of(model_text);
  const Mechanics m = mechanics(*model);
  Column values;
  for (const Parameter& p : model->parameters) values.push_back(p.value);
  const InitialProblem<double> problem{&m, evaluate_parameters<double>(*model->graph, values), std::move(overrides),
                                       std::nullopt};
  InitialState<double> state;
  return consistent_state(problem, state);
}

bool says(const Outcome& o, const std::string& words) { return o.message.find(words) != std::string::npos; }

TEST(Contradiction, OfVelocitiesNamesThoseThatClashAndNoOthers) {
  const Outcome o =
      solve(text({"x", "y", "u", "w"}, {"x' = u'", "u' = y'", "w' = 2*x' + 1"}, "\"x'\" = 1\n\"y'\" = 2\n"));
  ASSERT_EQ(o.kind, OutcomeKind::inconsistent);
  EXPECT_TRUE(says(o, "x' = 1")) << o.message;
  EXPECT_TRUE(says(o, "y' = 2"));
  EXPECT_TRUE(says(o, "'c1'"));
  EXPECT_TRUE(says(o, "'c2'"));
  EXPECT_FALSE(says(o, "'c3'")) << o.message;
  EXPECT_NE(o.hint.find("one of x', y'"), std::string::npos) << o.hint;
}

TEST(Contradiction, OfOneValueSaysWhatIsAskedInItsPlace) {
  // All constraints share the least miss; the constraint with the largest miss is not part of the contradiction.
  const Outcome o = solve(text({"x", "y", "u"}, {"x' + y' = u'", "1000*(x' - y') = 0", "y' = 0"}, "\"y'\" = 1\n"));
  ASSERT_EQ(o.kind, OutcomeKind::inconsistent);
  EXPECT_TRUE(says(o, "y' = 1 (line 24) clashes with constraint 'c3' (line 22), which asks for y' = 0 here"))
      << o.message;
}

TEST(Contradiction, OfConstraintsAloneBlamesNoValue) {
  const Outcome o = solve(text({"x", "y"}, {"x' = 1", "x' + y' = 2", "2*y' = 3"}, "x = 3\n\"y'\" = 1\n"));
  ASSERT_EQ(o.kind, OutcomeKind::inconsistent);
  // y' = 1 fits two of them and contradicts the third.
  EXPECT_TRUE(says(o, "y' = 1")) << o.message;
  EXPECT_TRUE(says(o, "'c3'"));
  EXPECT_FALSE(says(o, "'c1'"));
  const Outcome p = solve(text({"x", "y"}, {"x' = 1", "x' + y' = 2", "2*y' = 3"}, "x = 3\n"));
  ASSERT_EQ(p.kind, OutcomeKind::inconsistent);
  EXPECT_TRUE(says(p, "no velocities satisfy all of them")) << p.message;
}

TEST(Contradiction, OfPositionsIsFoundByLeavingOut) {
  // Two links: the first cannot reach x = 2, and the second does not take part in the contradiction.
  const Outcome o = solve(text({"x", "y", "u", "v"}, {"x^2 + y^2 = 1", "(u - x)^2 + (v - y)^2 = 1"},
                               "x = 2\nu = 1\nguess = {y = -1, v = -2}\n"));
  ASSERT_EQ(o.kind, OutcomeKind::inconsistent);
  EXPECT_TRUE(says(o, "x = 2")) << o.message;
  EXPECT_TRUE(says(o, "'c1'"));
  EXPECT_FALSE(says(o, "'c2'")) << o.message;
  EXPECT_FALSE(says(o, "u = 1")) << o.message;
}

TEST(Contradiction, OfPositionsThroughSeveralConstraints) {
  // The end of two links of length 1 is at most 2 away.
  const Outcome o = solve(text({"x", "y", "u", "v", "s"}, {"x^2 + y^2 = 1", "(u - x)^2 + (v - y)^2 = 1", "s = u"},
                               "u = 3\ns = 3\nguess = {y = -1, v = -2}\n"));
  ASSERT_EQ(o.kind, OutcomeKind::inconsistent);
  EXPECT_TRUE(says(o, "u = 3")) << o.message;
  EXPECT_TRUE(says(o, "'c1'"));
  EXPECT_TRUE(says(o, "'c2'"));
  EXPECT_FALSE(says(o, "'c3'")) << o.message;
}

TEST(Contradiction, WithTheCommandLineNamesItsValuesNotThoseOfTheFile) {
  const Outcome o = solve(text({"x", "y"}, {"y' = 0", "x' = 3"}, "\"x'\" = 3\n"), {{1, 1, Rational(1)}});
  ASSERT_EQ(o.kind, OutcomeKind::inconsistent);
  EXPECT_TRUE(says(o, "y' = 1 clashes with constraint 'c1'")) << o.message;
  EXPECT_FALSE(says(o, "x'")) << o.message;
}

// Random linear systems: with all members there is no solution, with any one left out there is.
TEST(Contradiction, OfLinearEquationsIsMinimal) {
  std::mt19937 random(20260);
  int clashes = 0, several = 0;
  for (int round = 0; round < 60; ++round) {
    const std::size_t n = 3 + random() % 4, equations = 2 + random() % 4;
    std::vector<std::string> coordinates, list;
    for (std::size_t j = 0; j < n; ++j) coordinates.push_back("q" + std::to_string(j));
    for (std::size_t i = 0; i < equations; ++i) {
      std::string e = std::to_string(static_cast<int>(random() % 5) - 2);
      for (std::size_t j = 0; j < n; ++j)
        if (const int c = static_cast<int>(random() % 5) - 2; c != 0 && random() % 2)
          e += " + (" + std::to_string(c) + ")*q" + std::to_string(j) + "'";
      list.push_back("3*q0' + " + e + " = 0");
    }
    const auto model = test::model_of(text(coordinates, list, ""));
    const Mechanics m = mechanics(*model);
    const StartPlan plan(m);
    Stage<double> stage(m, plan.velocities, {});
    InitialState<double> state;
    state.q.assign(n, 0), state.q_origin.assign(n, Origin::chosen);
    state.qd.assign(n, 0), state.qd_origin.assign(n, Origin::chosen);
    std::vector<bool> given(n, false);
    for (std::size_t j = 0; j < n; ++j)
      if (random() % 2) given[j] = true, state.qd[j] = static_cast<double>(random() % 7) - 3;
    const auto solvable = [&](const std::vector<bool>& rows, const std::vector<bool>& fixed) {
      InitialState<double> s = state;
      std::vector<std::size_t> free;
      for (std::size_t j = 0; j < n; ++j)
        if (!fixed[j]) free.push_back(j);
      stage.keep(rows);
      const bool found = find_by_least_change(stage, s, free) && stage.worst() < 1e-12;
      stage.keep_all();
      return found;
    };
    const bool whole = solvable(std::vector<bool>(stage.size(), true), given);
    const auto c = contradiction(stage, state, given, 0);
    EXPECT_EQ(c.has_value(), !whole);
    if (!c) continue;
    ++clashes;
    std::vector<bool> rows(stage.size(), false), fixed(n, false);
    for (std::size_t i : c->equations) rows[i] = true;
    for (std::size_t j : c->given) {
      fixed[j] = true;
      EXPECT_TRUE(given[j]);
    }
    several += c->equations.size() > 1 ? 1 : 0;
    EXPECT_FALSE(solvable(rows, fixed));
    for (std::size_t i : c->equations) {
      rows[i] = false;
      EXPECT_TRUE(solvable(rows, fixed)) << "without equation " << i << " of round " << round;
      rows[i] = true;
    }
    for (std::size_t j : c->given) {
      fixed[j] = false;
      EXPECT_TRUE(solvable(rows, fixed)) << "without value " << j << " of round " << round;
      fixed[j] = true;
    }
  }
  EXPECT_GT(clashes, 15);
  EXPECT_GT(several, 3);
}

}  // namespace
}  // namespace anholon::contradiction_test
