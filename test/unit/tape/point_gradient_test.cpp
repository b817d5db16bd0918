// Derivatives at single points of formulas with roots of sums of squares, where all squares vanish.
#include <cmath>

#include <gtest/gtest.h>

#include "expr/derivatives/point_gradient.h"
#include "expr/derivatives/squares.h"
#include "tape/bind.h"

namespace anholon::point_gradient_test {
namespace {

constexpr double kRoundOff = 1e-14;  // of a few operations with numbers below 10

class AtAPoint : public ::testing::Test {
 protected:
  std::vector<double> derivatives(Expr f, double at_x, double at_y, AtKinks at_kinks = AtKinks::no_value) {
    const Expr by[] = {x, y};
    const Tape tape = compile(point_gradient(f, by, at_kinks));
    Machine<double> m(tape, 0, {c_value});
    bind(m, g, [&](const Node& n, NodeId) { return n.index == 0 ? at_x : at_y; });
    m.evaluate();
    return {m.value(0), m.value(1)};
  }
  void expect_at_rest(Expr f, double by_x, double by_y) {
    for (const AtKinks at_kinks : {AtKinks::no_value, AtKinks::between}) {
      const std::vector<double> d = derivatives(f, 0, 0, at_kinks);
      EXPECT_EQ(d[0], by_x);
      EXPECT_EQ(d[1], by_y);
    }
  }

  Graph g;
  double c_value = 0;
  Expr x = g.jet(0, 0), y = g.jet(1, 0), c = g.parameter(0), u = x * x + y * y, r = sqrt(u);
};

TEST_F(AtAPoint, ADragHasTheDerivativeZeroAtRest) {
  expect_at_rest(r * x, 0, 0);
  expect_at_rest(3 * x - r * x, 3, 0);
  expect_at_rest(pow(u, {3, 4}) * x, 0, 0);
  expect_at_rest(pow(u, {1, 4}) * x, 0, 0);
  expect_at_rest(sqrt(x * x) * x, 0, 0);
  expect_at_rest(r * sqrt(x * x + 2 * (y * y)), 0, 0);  // of two roots
  expect_at_rest(u * (x / r), 0, 0);                    // a square times a direction
  expect_at_rest(c * r, 0, 0);                          // c = 0
  expect_at_rest(g.apply(Function::sin, r) * r, 0, 0);
  expect_at_rest(select(x, r * x, y), 0, 0);
}

TEST_F(AtAPoint, ElsewhereItHasThoseOfTheRules) {
  for (const AtKinks at_kinks : {AtKinks::no_value, AtKinks::between}) {
    const std::vector<double> d = derivatives(r * x, 3, 4, at_kinks);
    EXPECT_NEAR(d[0], 5 + 9.0 / 5, kRoundOff);
    EXPECT_NEAR(d[1], 12.0 / 5, kRoundOff);
    const std::vector<double> along = derivatives(r * x, 0, 4, at_kinks);
    EXPECT_NEAR(along[0], 4, kRoundOff);
    EXPECT_EQ(along[1], 0);
  }
}

TEST_F(AtAPoint, AKinkHasNoneOrTheOneBetween) {
  for (const Expr f : {r, r + x, r * x + 2 * r, sqrt(x * x + 2 * x * y + y * y)}) {
    EXPECT_FALSE(std::isfinite(derivatives(f, 0, 0)[0]));
    EXPECT_FALSE(std::isfinite(derivatives(f, 0, 0)[1]));
  }
  EXPECT_EQ(derivatives(r + 2 * x, 0, 0, AtKinks::between), (std::vector<double>{2, 0}));
  c_value = 1;
  EXPECT_FALSE(std::isfinite(derivatives(c * r, 0, 0)[0]));
}

// The product of the fourth root with its sine is of the order of |x|, and the root of x begins at 0.
TEST_F(AtAPoint, OtherRootsFollowTheRules) {
  const Expr fourth = pow(u, {1, 4});
  EXPECT_FALSE(std::isfinite(derivatives(g.apply(Function::sin, fourth) * fourth, 0, 0)[0]));
  EXPECT_FALSE(std::isfinite(derivatives(g.apply(Function::sin, sqrt(x)) * sqrt(x), 0, 0)[0]));
  EXPECT_FALSE(std::isfinite(derivatives(y * sqrt(x), 0, 0)[0]));
  EXPECT_NEAR(derivatives(y * sqrt(x), 4, 3)[0], 0.75, kRoundOff);
}

TEST_F(AtAPoint, SumsOfSquares) {
  const auto of = [&](Expr e) { return is_sum_of_squares(g, e.id); };
  const Expr sine = g.apply(Function::sin, y), arc = g.apply(Function::asin, x), size = g.apply(Function::abs, x);
  for (const Expr e : {u, x * x, 3 * (x * x), (x + y) * (x + y) + y * y, x * x * sine * sine, u * u, x * x * u,
                       size * size, pow(x + c * y, 2) + pow(sine, 4)})
    EXPECT_TRUE(of(e));
  for (const Expr e : {x, x * y, x * x - y * y, c * x * x, u + g.one(), r, pow(u, {3, 4}), size, arc * arc,
                       x * x + sqrt(y) * y, g.one()})
    EXPECT_FALSE(of(e));
}

}  // namespace
}  // namespace anholon::point_gradient_test
