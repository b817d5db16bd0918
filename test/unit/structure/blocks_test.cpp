// Blocks of equations that are solved together, their order, and the constraints of the state.
#include <gtest/gtest.h>

#include "structure/blocks.h"
#include "structure/consistent.h"
#include "support/models.h"
#include "tape/tape.h"

namespace anholon::blocks_test {
namespace {

struct Analysed {
  System system;
  Structure structure;
};

Analysed analysed(const std::shared_ptr<const Model>& model) {
  std::vector<std::size_t> all;
  for (std::size_t r = 0; r < model->constraints.size(); ++r) all.push_back(r);
  const Mechanics m = mechanics(*model);
  Analysed a;
  a.system = implicit_system(model, m, *find_formulation("routh"), all);
  Column values;
  for (const Parameter& p : model->parameters) values.push_back(p.value);
  // Hints come from the initial data: a launcher has no equations at the centre of the Earth.
  const std::vector<double> parameters = evaluate_parameters<double>(*model->graph, values);
  InitialState<double> start;
  ProbeHints hints;
  if (consistent_state(InitialProblem<double>{&m, parameters, {}, std::nullopt}, start).ok())
    hints = {{start.q, start.qd}, start.states, start.t};
  const Outcome o = analyse(a.system, parameters, hints, a.structure);
  EXPECT_TRUE(o.ok()) << o.message;
  return a;
}

using Names = std::vector<std::vector<std::string>>;

Names unknowns(const Analysed& a) {
  Names out;
  for (const Block& b : blocks(a.structure)) {
    out.emplace_back();
    for (std::size_t j : b.unknowns) out.back().push_back(a.system.variable_names[j]);
  }
  return out;
}

// Each equation needs, at the order at which it is solved, only unknowns of its own block and of earlier ones, and no
// block can be split: this defines blocks.
void expect_triangular(const Structure& t) {
  const std::vector<Block> list = blocks(t);
  std::vector<std::size_t> block_of(t.c.size(), SIZE_MAX);
  std::size_t equations = 0;
  for (std::size_t k = 0; k < list.size(); ++k) {
    EXPECT_EQ(list[k].equations.size(), list[k].unknowns.size());
    equations += list[k].equations.size();
    for (std::size_t j : list[k].unknowns) block_of[j] = k;
  }
  EXPECT_EQ(equations, t.c.size());
  for (std::size_t k = 0; k < list.size(); ++k)
    for (std::size_t i : list[k].equations)
      for (std::size_t j = 0; j < t.d.size(); ++j) {
        const bool needed = t.sigma[i][j] != kAbsent && t.sigma[i][j] == t.d[j] - t.c[i];
        EXPECT_TRUE(!needed || block_of[j] <= k) << i << ", " << j;
      }
}

TEST(Blocks, AnUncoupledCoordinateIsABlockOfItsOwn) {
  // The blade couples x, y and theta; z falls alone.
  const Analysed a = analysed(test::model_of("coordinates = [\"x\", \"y\", \"z\", \"s\"]\n[[particle]]\nname = "
                                             "\"p\"\nmass = 2\nposition = [\"x\", \"y\", \"z\"]\n"
                                             "[[particle]]\nname = \"q\"\nmass = 1\nposition = [\"s + x\", \"0\", "
                                             "\"0\"]\n[[constraint]]\nname = \"edge\"\nequation = \"x' = z*y'\"\n"));
  expect_triangular(a.structure);
  const Names names = unknowns(a);
  EXPECT_EQ(names.size(), 2U);
  EXPECT_NE(std::find(names.begin(), names.end(), std::vector<std::string>{"z"}), names.end());
}

TEST(Blocks, AThirdOrderConstraintLeavesTheFreeCoordinateAlone) {
  const Analysed a = analysed(test::shipped("zoo/third-order-linear"));
  expect_triangular(a.structure);
  const Names names = unknowns(a);
  ASSERT_EQ(names.size(), 2U);
  EXPECT_EQ(names[0], std::vector<std::string>{"z"});
  EXPECT_EQ(names[1].size(), 3U);
}

TEST(Blocks, AChainOfRodsIsOneBlock) {
  const Analysed a = analysed(test::shipped("zoo/double-pendulum-cartesian"));
  expect_triangular(a.structure);
  EXPECT_EQ(unknowns(a).size(), 1U);
}

TEST(Blocks, TriangularForEveryShippedModel) {
  for (const std::string& name : test::shipped_models()) {
    SCOPED_TRACE(name);
    const std::shared_ptr<const Model> model = test::shipped(name);
    EXPECT_EQ(model->unknown_functions.empty(), !name.ends_with("-symbolic"));  // test::moving_models() relies on this
    if (model->unknown_functions.empty()) expect_triangular(analysed(model).structure);
  }
}

TEST(Blocks, TheOrderIsThatOfTheDependences) {
  // Found by hand: equation 0 needs unknown 1, equations 1 and 2 need each other, 3 needs only 0.
  Structure t;
  constexpr int n = kAbsent;
  t.sigma = {{2, 2, n, n}, {n, 2, 2, n}, {n, 2, 2, n}, {2, n, n, 2}};
  t.transversal = {0, 1, 2, 3};
  t.c = {0, 0, 0, 0};
  t.d = {2, 2, 2, 2};
  const std::vector<Block> list = blocks(t);
  ASSERT_EQ(list.size(), 3U);
  EXPECT_EQ(list[0].equations, (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(list[1].equations, (std::vector<std::size_t>{0}));
  EXPECT_EQ(list[2].equations, (std::vector<std::size_t>{3}));
  // An entry below d - c does not occur in the Jacobian.
  t.sigma[2][1] = 1;
  EXPECT_EQ(blocks(t).size(), 4U);
}

TEST(HiddenConstraints, AreTheEquationsThatAreDifferentiated) {
  const Analysed pendulum = analysed(test::shipped("zoo/double-pendulum-cartesian"));
  const std::vector<HiddenConstraint> rods = hidden_constraints(pendulum.system, pendulum.structure);
  ASSERT_EQ(rods.size(), 2U);
  EXPECT_EQ(pendulum.system.equation_names[rods[0].equation], "rod1");
  EXPECT_EQ(rods[0].orders, (std::vector<int>{0, 1}));
  // For a linear constraint of third order the equations of motion themselves relate accelerations and multipliers.
  const Analysed jerk = analysed(test::shipped("zoo/third-order-linear"));
  const std::vector<HiddenConstraint> rows = hidden_constraints(jerk.system, jerk.structure);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_LT(rows[0].equation, jerk.system.coordinates);
  EXPECT_EQ(rows[0].orders, (std::vector<int>{2}));
}

}  // namespace
}  // namespace anholon::blocks_test
