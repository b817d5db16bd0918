// Signature, offsets and dimension of the examples (theory: dae-view).
#include <gtest/gtest.h>

#include "structure/structure.h"
#include "support/models.h"
#include "tape/tape.h"

namespace anholon::structure_test {
namespace {

struct Analysed {
  std::shared_ptr<const Model> model;
  System system;
  Structure structure;
  Outcome outcome;
};

Analysed analysed(std::shared_ptr<const Model> model) {
  Analysed a;
  a.model = model;
  std::vector<std::size_t> all;
  for (std::size_t r = 0; r < model->constraints.size(); ++r) all.push_back(r);
  const Mechanics m = mechanics(*model);
  a.system = implicit_system(model, m, *find_formulation("routh"), all);
  Column values;
  for (const Parameter& p : model->parameters) values.push_back(p.value);
  a.outcome = analyse(a.system, evaluate_parameters<double>(*model->graph, values), {}, a.structure);
  return a;
}

using Ints = std::vector<int>;

void expect(const Analysed& a, const Ints& c, const Ints& d, int dimension) {
  EXPECT_TRUE(a.outcome.ok()) << a.outcome.message;
  EXPECT_EQ(a.structure.c, c);
  EXPECT_EQ(a.structure.d, d);
  EXPECT_EQ(a.structure.state_dimension, dimension);
  // d_j - c_i >= sigma_ij, with equality on the transversal: this makes the offsets valid.
  for (std::size_t i = 0; i < a.structure.c.size(); ++i) {
    for (std::size_t j = 0; j < a.structure.d.size(); ++j)
      EXPECT_TRUE(a.structure.sigma[i][j] == kAbsent || a.structure.d[j] - a.structure.c[i] >= a.structure.sigma[i][j])
          << i << ", " << j;
    const std::size_t j = static_cast<std::size_t>(a.structure.transversal[i]);
    EXPECT_EQ(a.structure.d[j] - a.structure.c[i], a.structure.sigma[i][j]);
  }
}

std::string particle(const std::string& constraints, const std::string& more = {}) {
  return "coordinates = [\"x\", \"y\", \"z\"]\n[parameters]\nm = 2\nkx = 3\nky = 2\nkz = 1\nkk = "
         "0.5\n[[particle]]\nname = \"p\"\nmass = \"m\"\n"
         "position = [\"x\", \"y\", \"z\"]\n[[force]]\nname = \"springs\"\non = \"p\"\nvector = [\"-kx*x\", \"-ky*y\", "
         "\"-kz*z\"]\n" +
         constraints + more;
}
std::string constraint(const std::string& name, const std::string& equation) {
  return "[[constraint]]\nname = \"" + name + "\"\nequation = \"" + equation + "\"\n";
}

TEST(Structure, Unconstrained) { expect(analysed(test::model_of(particle(""))), {0, 0, 0}, {2, 2, 2}, 6); }

TEST(Structure, FirstOrderSleigh) {
  expect(analysed(test::shipped("zoo/chaplygin-sleigh")), {0, 0, 0, 1}, {2, 2, 2, 0}, 5);
}

TEST(Structure, FirstOrderNonlinear) {
  expect(analysed(test::shipped("zoo/appell-hamel")), {0, 0, 0, 1}, {2, 2, 2, 0}, 5);
}

TEST(Structure, SecondOrderLinear) {
  expect(analysed(test::shipped("zoo/second-order-linear")), {0, 0, 0, 0}, {2, 2, 2, 0}, 6);
}

TEST(Structure, Holonomic) {
  expect(analysed(test::shipped("zoo/fourbar")), {0, 0, 0, 2, 2}, {2, 2, 2, 0, 0}, 2);
  expect(analysed(test::shipped("zoo/double-pendulum-cartesian")), {0, 0, 0, 0, 2, 2}, {2, 2, 2, 2, 0, 0}, 4);
}

TEST(Structure, ThirdOrderLinearHasItsMultiplierAsState) {
  const Analysed a =
      analysed(test::model_of(particle(constraint("jerk", "x''' - (1 + z'/2)*y''' + kk*x''*y' + z = 0"))));
  expect(a, {1, 1, 0, 0}, {3, 3, 2, 1}, 7);
  constexpr int n = kAbsent;
  EXPECT_EQ(a.structure.sigma, (std::vector<Ints>{{2, n, n, 0}, {n, 2, 1, 0}, {n, n, 2, n}, {3, 3, 1, n}}));
}

TEST(Structure, OrderTwoNonlinearAndOrderThreeNonlinear) {
  expect(analysed(test::model_of(particle(constraint("a", "x''^2 + y''^2 + z''^2 = 4")))), {0, 0, 0, 0}, {2, 2, 2, 0},
         6);
  expect(analysed(test::model_of(particle(constraint("j", "x'''^2 + y'''^2 + z'''^2 = 4")))), {0, 0, 0, 0},
         {3, 3, 3, 0}, 9);
}

TEST(Structure, MixedOrdersEachHaveTheirRow) {
  const Analysed a = analysed(
      test::model_of(particle(constraint("sphere", "x^2 + y^2 + z^2 = 4") + constraint("edge", "x' + z*y' = 0"))));
  expect(a, {0, 0, 0, 2, 1}, {2, 2, 2, 0, 0}, 3);
}

TEST(Structure, TheDegreesOfFreedomAreIndependentVelocities) {
  EXPECT_EQ(analysed(test::shipped("zoo/chaplygin-sleigh")).structure.degrees_of_freedom, 2);
  EXPECT_EQ(analysed(test::shipped("zoo/fourbar")).structure.degrees_of_freedom, 1);
  EXPECT_EQ(analysed(test::shipped("zoo/fourbar")).structure.configuration_dimension, 1);
}

TEST(Structure, ADerivativeThatCancelsDoesNotCount) {
  // In x'' sin^2 + x'' cos^2 - x'' the symbol occurs, but the derivative does not.
  const std::string text = particle(constraint("c", "z*(sin(x)^2 + cos(x)^2 - 1)*y'' + x' = y'"));
  expect(analysed(test::model_of(text)), {0, 0, 0, 1}, {2, 2, 2, 0}, 5);
}

TEST(Structure, AMassThatDependsOnTheAccelerationRaisesTheOrder) {
  const std::string text = "coordinates = [\"x\"]\n[[particle]]\nname = \"p\"\nmass = \"2 + x''^2/10\"\nposition = "
                           "\"x*ex\"\nexpelled_velocity = \"-ex\"\n";
  const Analysed a = analysed(test::model_of(text));
  EXPECT_EQ(a.structure.sigma[0][0], 3);
  EXPECT_EQ(a.structure.state_dimension, 3);
}

TEST(Structure, AnUnknownThatNoEquationDeterminesIsSingular) {
  const std::string text = "coordinates = [\"x\", \"y\"]\n[[particle]]\nname = \"p\"\nmass = 1\nposition = \"x*ex\"\n";
  EXPECT_EQ(analysed(test::model_of(text)).outcome.kind, OutcomeKind::singular);
}

}  // namespace
}  // namespace anholon::structure_test
