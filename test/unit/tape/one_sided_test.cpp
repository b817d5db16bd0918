// Formulas on both sides of a border between branches: which of them have a derivative there.
#include <cmath>

#include <gtest/gtest.h>

#include "expr/table.h"
#include "tape/one_sided.h"

namespace anholon::one_sided_test {
namespace {

constexpr double kRoundOff = 1e-14;  // of a few operations with numbers below 10

// True if the value or the derivative of f(x) differs on the two sides of a border at x; nullopt if x lies on no
// border.
std::optional<bool> rough(Expr f, Expr x, double at) {
  const OneSided sides({f}, {x}, 0);
  const auto found = sides.sides<double>(
      {}, 0, [&](Machine<double>& m) { bind(m, *f.graph, [&](const Node&, NodeId) { return at; }); });
  if (found.empty()) return std::nullopt;
  for (const auto& side : found)
    for (std::size_t k = 0; k < side.below.size(); ++k)
      if (std::abs(side.below[k] - side.above[k]) > kRoundOff) return true;
  return false;
}

class BordersOfBranches : public ::testing::Test {
 protected:
  Graph g;
  Expr x = g.jet(0, 0), zero = g.zero();
};

TEST_F(BordersOfBranches, KinksAndJumpsDifferOnBothSides) {
  const Expr abs = g.apply(Function::abs, x), sign = g.apply(Function::sign, x);
  for (const Expr f : {select(-x, x, zero), abs, sign, abs + x * x, select(x, x, -x)}) {
    EXPECT_EQ(rough(f, x, 0), true);
    EXPECT_EQ(rough(f, x, 0.5), std::nullopt);
  }
}

TEST_F(BordersOfBranches, SidesThatAgreeHaveADerivative) {
  const Expr abs = g.apply(Function::abs, x);
  EXPECT_EQ(rough(x * abs, x, 0), false);
  EXPECT_EQ(rough(select(x - g.one(), x * x, 2 * x - g.one()), x, 1), false);
}

TEST_F(BordersOfBranches, TablesHaveThemAtKnots) {
  Table t{"F", {-1, 0, 1}, {4, 0, -9}};
  EXPECT_EQ(rough(TableFunction(g, t)(x), x, 0), true);
  EXPECT_EQ(rough(TableFunction(g, t)(x), x, 0.5), std::nullopt);
  t.fit = Fit::spline;
  EXPECT_EQ(rough(TableFunction(g, t)(x), x, 0).value_or(true), false);
}

}  // namespace
}  // namespace anholon::one_sided_test
