#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/resource.h>

#include "expr/diff.h"
#include "print/print.h"
#include "support/random_expr.h"
#include "support/value.h"

namespace anholon::diff_test {
namespace {

using test::distance, test::Point, test::RandomExpr, test::value;

constexpr int kRandomExpressions = 60;

struct Symbols {
  Graph g;
  Expr x = g.jet(0, 0), y = g.jet(1, 0), xd = g.jet(0, 1), yd = g.jet(1, 1), a = g.parameter(0), t = g.time();
  std::vector<Expr> atoms = {x, y, xd, yd, a, t};
};

Multi central_difference(Expr e, Expr symbol, const Point& at, const Multi& h) {
  const Multi x = at(*e.graph, symbol.id);
  Point up = at, down = at;
  up.set(symbol, x + h);
  down.set(symbol, x - h);
  return (value(e, up) - value(e, down)) / (Multi(2) * h);
}

TEST(Gradient, IsTheLimitOfDifferences) {
  const PrecisionScope precision(70);
  const Multi h = test::raise(Multi(10), Rational(-20));
  const double tolerance =
      1e-30;  // h^2 times third derivatives of moderate size; 50 digits are left in the differences
  Symbols s;
  for (std::uint32_t k = 1; k <= kRandomExpressions; ++k) {
    const Expr e = RandomExpr(s.g, k, s.atoms).make(4);
    const Column d = gradient(e, s.atoms);
    const Point at(k);
    for (std::size_t i = 0; i < d.size(); ++i) {
      const Multi difference = central_difference(e, s.atoms[i], at, h);
      ASSERT_LE(distance(value(d[i], at), difference), tolerance) << k << ": " << print(e, {}, Format::text);
    }
  }
}

TEST(Gradient, EveryElementaryFunctionHasItsDerivative) {
  const PrecisionScope precision(70);
  const Multi h = test::raise(Multi(10), Rational(-20));
  Symbols s;
  RandomExpr make(s.g, 1, s.atoms);
  for (int k = 0; k < static_cast<int>(RandomExpr::kFunctions); ++k) {
    const Expr e = make.function(k, s.x);
    const Multi difference = central_difference(e, s.x, Point(5), h);
    EXPECT_LE(distance(value(partial(e, s.x), Point(5)), difference), 1e-35) << info(static_cast<Function>(k)).name;
    const bool flat = static_cast<Function>(k) == Function::sign;
    EXPECT_EQ(distance(difference, Multi(0)) < 1e-35, flat) << "mutant: no derivative at all";
  }
}

TEST(Gradient, ReverseSweepAndOneByOneAgree) {
  const PrecisionScope precision(40);
  Symbols s;
  for (std::uint32_t k = 1; k <= kRandomExpressions; ++k) {
    const Expr e = RandomExpr(s.g, 1000 + k, s.atoms).make(4);
    const Column all = gradient(e, s.atoms);
    for (std::size_t i = 0; i < all.size(); ++i)
      ASSERT_LE(distance(value(all[i], Point(k)), value(partial(e, s.atoms[i]), Point(k))), 1e-35);
  }
}

TEST(Gradient, OfASymbolThatDoesNotOccurIsZero) {
  Symbols s;
  EXPECT_TRUE(is_zero(partial(sin(s.x), s.y)));
  EXPECT_TRUE(is_zero(partial(sin(s.x), s.xd))) << "jets are independent";
}

TEST(Pullback, IsTheGradientOfTheSumWithSeedsHeld) {
  const PrecisionScope precision(40);
  Symbols s;
  for (std::uint32_t k = 1; k <= 20; ++k) {
    RandomExpr make(s.g, 2000 + k, s.atoms);
    const Column outputs = {make.make(3), make.make(3), make.make(2)},
                 seeds = {make.make(2), make.make(1), make.atom()};
    const Column pulled = pullback(outputs, seeds, s.atoms);
    for (std::size_t i = 0; i < s.atoms.size(); ++i) {
      Multi expected(0);
      for (std::size_t c = 0; c < outputs.size(); ++c)
        expected += value(seeds[c], Point(k)) * value(partial(outputs[c], s.atoms[i]), Point(k));
      ASSERT_LE(distance(value(pulled[i], Point(k)), expected), 1e-33);
    }
  }
}

// Along x(t) = sum x_k t^k the k-th total derivative at t = 0 is k! times the k-th Taylor coefficient of e(x(t), t).
TEST(TotalDerivative, IsTheChainRule) {
  constexpr int kOrders = 3;
  const PrecisionScope precision(60);
  for (std::uint32_t k = 1; k <= 25; ++k) {
    Graph g;
    const Expr x = g.jet(0, 0), y = g.jet(1, 0), xd = g.jet(0, 1), t = g.time(), mu = g.mass(0), f = g.given(0, 0),
               lambda = g.multiplier(0, 0);
    const std::vector<Expr> atoms = {x, y, xd, t, mu, f, lambda, g.parameter(0)};
    const Expr e = RandomExpr(g, 3000 + k, atoms).make(3);
    const Point start(k);
    // Derivatives of the k-th order of x, y, f, lambda at 0 are the values of their symbols.
    const auto along = [&](const Multi& tau) {
      Point p = start;
      const auto path = [&](auto symbol, unsigned order) {
        Multi v(0), factor(1);
        for (unsigned i = order; i < 8; ++i) {
          v += start(g, symbol(i).id) * factor;
          factor = factor * tau / Multi(static_cast<int>(i - order + 1));
        }
        p.set(symbol(order), v);
      };
      path([&](unsigned i) { return g.jet(0, i); }, 0);
      path([&](unsigned i) { return g.jet(0, i); }, 1);
      path([&](unsigned i) { return g.jet(1, i); }, 0);
      path([&](unsigned i) { return g.given(0, i); }, 0);
      path([&](unsigned i) { return g.multiplier(0, i); }, 0);
      p.set(t, start(g, t.id) + tau);
      return value(e, p);
    };
    const std::vector<Multi> series = test::taylor_by_differences(along, kOrders);
    Multi factorial(1);
    for (int order = 1; order <= kOrders; ++order) {
      factorial *= Multi(order);
      const Multi d = value(total_derivative(e, static_cast<unsigned>(order)), start);
      ASSERT_LE(distance(d, Multi(series[static_cast<std::size_t>(order)] * factorial)), 1e-28)
          << k << ", order " << order;
    }
  }
}

TEST(TotalDerivative, HoldsFrozenMasses) {
  Graph g;
  const Expr mu = g.mass(0), x = g.jet(0, 0);
  EXPECT_EQ(total_derivative(mu * x), mu * g.jet(0, 1));
  EXPECT_EQ(total_derivative(g.parameter(0) * g.time()), g.parameter(0));
}

TEST(Substitute, GivesTheValueAtThePutInPoint) {
  const PrecisionScope precision(40);
  Symbols s;
  for (std::uint32_t k = 1; k <= kRandomExpressions; ++k) {
    RandomExpr make(s.g, 4000 + k, s.atoms);
    const Expr e = make.make(4), image = make.make(2);
    const Expr put = substitute({&e, 1}, [&](NodeId id) { return id == s.x.id ? image : Expr{}; })[0];
    Point moved(k);
    moved.set(s.x, value(image, Point(k)));
    ASSERT_LE(distance(value(put, Point(k)), value(e, moved)), 1e-33);
  }
}

TEST(Substitute, OfNothingIsTheSameExpression) {
  Symbols s;
  for (std::uint32_t k = 1; k <= 20; ++k) {
    const Expr e = RandomExpr(s.g, 5000 + k, s.atoms).make(4);
    EXPECT_EQ(substitute({&e, 1}, [](NodeId) { return Expr{}; })[0], e);
    const Expr again = substitute({&e, 1}, [&](NodeId id) { return Expr{&s.g, id}; })[0];
    EXPECT_EQ(again, e);
  }
}

// ---- depth ---------------------------------------------------------------------------------------------------------

constexpr int kDeep = 100000;

Expr deep(Graph& g, int depth) {
  Expr e = g.jet(0, 0);
  for (int k = 0; k < depth; ++k) e = g.jet(1, 0) + sin(e);
  return e;
}

TEST(Depth, TotalDerivativeAndSubstitutionDoNotOverflow) {
  Graph g;
  const Expr e = deep(g, kDeep);
  EXPECT_FALSE(is_zero(total_derivative(e)));
  const Expr put = substitute({&e, 1}, [&](NodeId id) { return id == g.jet(0, 0).id ? g.jet(2, 0) : Expr{}; })[0];
  EXPECT_EQ(symbols({&put, 1}), (std::vector<NodeId>{g.jet(1, 0).id, g.jet(2, 0).id}));
  EXPECT_EQ(jet_order(e), 0);
}

// Runs a check in its own process with at most 1 GiB; the process exits with 0 if the check ends.
void within_memory(void (*check)()) {
  const rlimit limit{1UL << 30, 1UL << 30};
  setrlimit(RLIMIT_AS, &limit);
  try {
    check();
  } catch (const std::bad_alloc&) {
    std::_Exit(1);
  }
  std::_Exit(0);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(Depth, PrintingADeepFormulaTakesMemoryInProportion) {
  EXPECT_EXIT(within_memory([] {
                Graph g;
                if (print(deep(g, kDeep), {}, Format::text).empty()) std::_Exit(2);
              }),
              testing::ExitedWithCode(0), "");
}

// The memory in use by the gradient of n nested functions.
std::size_t memory_of_gradient(int depth) {
  Graph g;
  const Expr e = deep(g, depth);
  const auto in_use = [] { return mallinfo2().uordblks + mallinfo2().hblkhd; };
  const std::size_t before = in_use();
  if (is_zero(partial(e, g.jet(0, 0)))) ADD_FAILURE();
  return in_use() - before;
}

TEST(Depth, TheGradientOfADeepFormulaTakesMemoryInProportion) {
  const std::size_t at1000 = memory_of_gradient(1000), at2000 = memory_of_gradient(2000);
  EXPECT_LE(at2000, 3 * at1000) << "twice the depth, twice the memory; vectors may be up to twice too long";
}
#endif

}  // namespace
}  // namespace anholon::diff_test
