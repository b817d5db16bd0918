#include <gtest/gtest.h>

#include "structure/redundancy.h"
#include "support/models.h"

namespace anholon::redundancy_test {
namespace {

// A particle with the constraints listed, separated by semicolons.
IndependentConstraints choice_of(const std::string& constraints, const std::string& initial) {
  std::string text =
      "coordinates = [\"x\", \"y\", \"z\"]\n[[particle]]\nname = \"p\"\nmass = 1\nposition = [\"x\", \"y\", \"z\"]\n";
  for (std::size_t at = 0, k = 0; at < constraints.size(); ++k) {
    const std::size_t end = std::min(constraints.find(';', at), constraints.size());
    text += "[[constraint]]\nname = \"c" + std::to_string(k) + "\"\nequation = \"" + constraints.substr(at, end - at) +
            "\"\n";
    at = end + 1;
  }
  const auto model = test::model_of(text + "[initial]\n" + initial);
  const Mechanics m = mechanics(*model);
  InitialState<double> s;
  EXPECT_TRUE(consistent_state(InitialProblem<double>{&m, {}, {}, std::nullopt}, s).ok());
  return independent_constraints(m, {}, s);
}

using Indices = std::vector<std::size_t>;

TEST(IndependentConstraints, LeaveOutWhatFollowsFromTheOthers) {
  const IndependentConstraints c = choice_of("x' = 3*y';2*x' = 6*y'", "\"y'\" = 1\n");
  EXPECT_EQ(c.independent, Indices{0});
  EXPECT_EQ(c.redundant, Indices{1});
}

TEST(IndependentConstraints, KeepTheLowerOrder) {
  EXPECT_EQ(choice_of("x'' = 3*y'';x' = 3*y'", "\"y'\" = 1\n").independent, Indices{1});
  EXPECT_EQ(choice_of("x' = 3*y';x''' = 3*y''';x = 3*y", "\"y'\" = 1\n").independent, Indices{2});
}

TEST(IndependentConstraints, LeaveOutWhatVanishesWithTheParameters) {
  const auto rows = [](const std::string& s, const std::string& x) {
    const auto model = test::model_of("coordinates = [\"x\", \"y\"]\nparameters = {s = " + s +
                                      ", k = \"s*2\"}\nparticle = [{name = \"p\", mass = 1, position = [\"x\", \"y\", "
                                      "\"0\"]}]\nconstraint = [{name = \"c\", equation = \"k*x*(x' - y') = 0\"}]\n"
                                      "initial = {x = " +
                                      x + "}\n");
    const Mechanics m = mechanics(*model);
    Column values;
    for (const Parameter& p : model->parameters) values.push_back(p.value);
    const InitialProblem<double> problem{&m, evaluate_parameters<double>(*model->graph, values), {}, std::nullopt};
    InitialState<double> state;
    EXPECT_TRUE(consistent_state(problem, state).ok());
    return independent_constraints(m, problem.parameters, state);
  };
  EXPECT_EQ(rows("0", "1").redundant, Indices{0});
  EXPECT_EQ(rows("0", "1").vanishing, Indices{0});
  EXPECT_EQ(rows("1", "1").independent, Indices{0});
  // A row that vanishes at the start alone is a singularity.
  EXPECT_EQ(rows("1", "0").independent, Indices{0});
  EXPECT_TRUE(rows("1", "0").vanishing.empty());
}

// The rows of the two constraints are (2 x0'', 2 x11'') and (x11'', x0''). Accelerations are no part of the state, so
// the rows are taken at generic values: at x0'' = x11'' they would be parallel, and one constraint would be called
// redundant.
TEST(IndependentConstraints, AreNotRedundantByAccident) {
  std::string text = "coordinates = [";
  for (int a = 0; a < 12; ++a) text += (a ? ", \"x" : "\"x") + std::to_string(a) + "\"";
  text += "]\n";
  for (int a = 0; a < 12; ++a) {
    const std::string k = std::to_string(a);
    text += "[[particle]]\nname = \"p" + k + "\"\nmass = 1\nposition = [\"x" + k + "\", \"0\", \"0\"]\n";
  }
  text += "[[constraint]]\nname = \"sphere\"\nequation = \"x0''^2 + x11''^2 = 1\"\n"
          "[[constraint]]\nname = \"saddle\"\nequation = \"x0''*x11'' = 1/4\"\n";
  const auto model = test::model_of(text);
  const Mechanics m = mechanics(*model);
  InitialState<double> s;
  s.q.assign(12, 0.0), s.qd.assign(12, 0.0);
  const IndependentConstraints c = independent_constraints(m, {}, s);
  EXPECT_EQ(c.independent, (Indices{0, 1}));
  EXPECT_TRUE(c.redundant.empty());
}

// The second row nearly equals the first; the third is far from it.
TEST(IndependentConstraints, PreferRowsFarFromDependent) {
  const IndependentConstraints c = choice_of("x' = 3*y';x' = 3*y' + z'/1000;x' = z' + 3*y'", "\"y'\" = 0\n");
  EXPECT_EQ(c.independent, (Indices{0, 2}));
  EXPECT_EQ(c.redundant, Indices{1});
}

TEST(IndependentConstraints, TakeNearlyDependentRowsIfThereIsNoBetter) {
  const IndependentConstraints c = choice_of("x' = 3*y';x' = 3*y' + z'/1000", "\"y'\" = 0\n");
  EXPECT_EQ(c.independent, (Indices{0, 1}));
  EXPECT_LT(c.weakest, 1e-3);
}

TEST(IndependentConstraints, RowsThatVanishStayIn) {
  EXPECT_EQ(choice_of("x' = 3*y';x'^2 = 0", "\"y'\" = 0\n").independent, (Indices{0, 1}));
}

// The third row is twice the first plus half of the second.
TEST(LeastMultipliers, AreTheLeastWithTheSameForces) {
  Matrix<double> phi(3, 2);
  phi(0, 0) = 1, phi(1, 1) = 3, phi(2, 0) = 2, phi(2, 1) = 1.5;
  const std::vector<double> lambda = least_multipliers<double>(phi, {0, 1}, {5, -2});
  for (std::size_t a = 0; a < 2; ++a) {
    double force = 0;
    for (std::size_t i = 0; i < 3; ++i) force += phi(i, a) * lambda[i];
    EXPECT_NEAR(force, a == 0 ? 5 : -6, 1e-14);
  }
  // lambda has no part along (2, 1/2, -1), the kernel of Phi^T.
  EXPECT_NEAR(2 * lambda[0] + lambda[1] / 2 - lambda[2], 0, 1e-14);
}

// The third row follows from the first alone, and the last two from the second and the fourth.
TEST(Dependencies, HaveTheRowsThatTakePart) {
  Matrix<double> phi(5, 3);
  phi(0, 0) = 1e6, phi(1, 1) = 3, phi(2, 0) = 2, phi(3, 2) = 1, phi(4, 1) = 6, phi(4, 2) = -1;
  IndependentConstraints choice;
  choice.independent = {0, 1, 3}, choice.redundant = {2, 4};
  const std::vector<Dependency> list = dependencies(phi, choice);
  ASSERT_EQ(list.size(), 2U);
  for (const Dependency& d : list)
    for (std::size_t a = 0; a < 3; ++a) {
      double sum = 0;
      for (std::size_t i = 0; i < 5; ++i) sum += d[i] * phi(i, a);
      EXPECT_NEAR(sum, 0, 1e-15);
    }
  const auto rows = [](const Dependency& d) {
    Indices of;
    for (std::size_t i = 0; i < d.size(); ++i)
      if (d[i] != 0) of.push_back(i);
    return of;
  };
  EXPECT_EQ(rows(list[0]), (Indices{0, 2}));
  EXPECT_EQ(rows(list[1]), (Indices{1, 3, 4}));
}

TEST(Dependencies, AreEmptyForARowThatDoesNotFollow) {
  Matrix<double> phi(2, 2);
  phi(0, 0) = 1, phi(1, 0) = 1, phi(1, 1) = 1e-3;
  IndependentConstraints choice;
  choice.independent = {0}, choice.redundant = {1};
  EXPECT_TRUE(dependencies(phi, choice)[0].empty());
}

}  // namespace
}  // namespace anholon::redundancy_test
