#include <cmath>

#include <gtest/gtest.h>

#include "proof/few_functions.h"
#include "tape/point.h"

namespace anholon::few_functions_test {
namespace {

struct Symbols {
  Graph g;
  Expr x = g.jet(0, 0), y = g.jet(1, 0), p = g.parameter(0), turn = g.pi();

  Expr number(const Rational& r) const { return x.graph->number(r); }
  bool shown(Expr e) const { return shown_zero_in_few_functions(e, Effort::full); }

  // Formulas in all functions that are rewritten.
  std::vector<Expr> formulas() const {
    const Expr u = x - 2 * y;
    return {abs(u) * u,
            pow(u, 3) * sign(u),
            pow(u, 2) * pow(sign(u), 2),
            abs(u) * sign(u) * u,
            sign(u) + x,
            exp(3 + (2 * x - y)),
            exp(Rational(1, 2) * log(1 + x * x) - x),
            sinh(u) * cosh(x) - tanh(x - 1),
            sqrt(pow(x, 2) * (1 + y * y)),
            sqrt(pow(x, 3) * x * pow(y, 6)),
            pow(pow(x, 2) * pow(y, 4) + pow(x, 4) * pow(y, 2), {3, 2}),
            pow(1 + x * x, {-1, 2}),
            pow(pow(x, 2) + pow(u, 2), {1, 3}),
            sqrt(sin(x) * sin(x) + cos(x) * cos(x)) + atan2(abs(x) * x, 1 + u * u),
            select(u, abs(x), -(x * sign(x))),
            sin(u + Rational(1, 3) * turn) * tan(x - Rational(5, 6) * turn),
            cos(x + Rational(7, 12) * turn) - tan(y + Rational(1, 4) * turn),
            sqrt(number(360)) * pow(number(Rational(10, 21)), {3, 2})};
  }
};

TEST(FewFunctions, KeepTheValue) {
  const Symbols s;
  for (int k = 0; k < 40; ++k) {
    PointValues at([&](const Node& n) { return std::sin(7.0 * k + 3.0 * n.index + 1) * 2; });
    for (const Expr e : s.formulas()) {
      const double value = at(e), few = at(in_few_functions(e));
      EXPECT_NEAR(few, value, 1e-11 * (1 + std::abs(value))) << "point " << k << ", node " << e.id;
    }
  }
}

TEST(FewFunctions, ShowWhatIsEqual) {
  const Symbols s;
  const auto &x = s.x, &y = s.y;
  EXPECT_TRUE(s.shown(pow(abs(x), 2) - x * x));
  EXPECT_TRUE(s.shown(x * sign(x) - abs(x)));
  EXPECT_TRUE(s.shown(sqrt(x * x + 2 * (x * y) + y * y) - abs(x + y)));
  EXPECT_TRUE(s.shown(sqrt(pow(x, 4)) - x * x));
  EXPECT_TRUE(s.shown(sqrt(pow(cos(x) * y, 2) + pow(sin(x) * y, 2)) - abs(y)));
  EXPECT_TRUE(s.shown(exp(x + 2 * y) - exp(x) * pow(exp(y), 2)));
  EXPECT_TRUE(s.shown(pow(cosh(x), 2) - pow(sinh(x), 2) - 1));
  EXPECT_TRUE(s.shown(tanh(2 * x) - 2 * tanh(x) / (1 + pow(tanh(x), 2))));
  EXPECT_TRUE(s.shown(exp(2 * log(x)) - x * x));
  const Expr third = Rational(1, 3) * s.turn, root3 = sqrt(s.number(3));
  EXPECT_TRUE(s.shown(2 * sin(x + third) - sin(x) - root3 * cos(x)));
  EXPECT_TRUE(s.shown(tan(x + s.turn) - tan(x)));
  EXPECT_TRUE(s.shown(4 * cos(Rational(5, 12) * s.turn) - sqrt(s.number(6)) + sqrt(s.number(2))));
}

TEST(FewFunctions, SplitLogarithmsKeepTheValue) {
  const Symbols s;
  const auto &x = s.x, &y = s.y;
  const std::vector<Expr> formulas = {log(x * x),
                                      log(6 * pow(x, 2) * pow(1 + y * y, -3)),
                                      log(sqrt(x * x * pow(x - 2 * y, 2))),
                                      log(abs(x)) * log(exp(y) * pow(x, 4)),
                                      log(Rational(5, 6) * abs(y)),
                                      exp(s.p * log(x * x)) + log(1 + pow(x - y, 2))};
  for (int k = 0; k < 40; ++k) {
    PointValues at([&](const Node& n) { return std::sin(7.0 * k + 3.0 * n.index + 1) * 2; });
    for (const Expr e : formulas) {
      const double value = at(e), split = at(with_split_logarithms(e));
      EXPECT_NEAR(split, value, 1e-11 * (1 + std::abs(value))) << "point " << k << ", node " << e.id;
    }
  }
}

TEST(FewFunctions, ShowLogarithmsOfProducts) {
  Symbols s;
  const auto &x = s.x, &y = s.y;
  EXPECT_TRUE(s.shown(log(x * x) - 2 * log(abs(x))));
  EXPECT_TRUE(s.shown(log(x * x) - 2 * log(x)));  // where both have values
  EXPECT_TRUE(s.shown(log(6 * x * y) - log(s.g.number(2)) - log(s.g.number(3)) - log(x) - log(y)));
  EXPECT_TRUE(s.shown(log(sqrt(1 + y * y)) - Rational(1, 2) * log(1 + y * y)));
  EXPECT_TRUE(s.shown(log(pow(x - y, 2)) - 2 * log(abs(y - x))));
  EXPECT_TRUE(s.shown(log(exp(x) * pow(y, 2)) - x - 2 * log(abs(y))));
  EXPECT_FALSE(s.shown(log(x * x) - log(abs(x))));
  EXPECT_FALSE(s.shown(log(x * x + y * y) - 2 * log(abs(x + y))));
  EXPECT_FALSE(s.shown(log(x * y) - log(x) + log(y)));
  EXPECT_FALSE(s.shown(log(6 * x) - log(x) - log(s.g.number(5))));
}

TEST(FewFunctions, ShowAnglesOfRationalNumbers) {
  Symbols s;
  const Expr one = s.g.one();
  EXPECT_TRUE(s.shown(4 * atan(one) - one.graph->pi()));
  EXPECT_TRUE(s.shown(atan(-one) + Rational(1, 4) * one.graph->pi()));
  EXPECT_TRUE(s.shown(6 * asin(Rational(1, 2) * one) - one.graph->pi()));
  EXPECT_TRUE(s.shown(2 * asin(-one) + one.graph->pi()));
  EXPECT_TRUE(s.shown(3 * acos(Rational(1, 2) * one) - one.graph->pi()));
  EXPECT_TRUE(s.shown(3 * acos(Rational(-1, 2) * one) - 2 * one.graph->pi()));
  EXPECT_TRUE(s.shown(acos(-one) - one.graph->pi()));
  EXPECT_TRUE(s.shown(2 * acos(s.g.zero()) - one.graph->pi()));
  EXPECT_FALSE(s.shown(3 * atan(one) - one.graph->pi()));
  EXPECT_FALSE(s.shown(3 * acos(Rational(-1, 2) * one) - one.graph->pi()));
}

TEST(FewFunctions, ShowChoicesBySigns) {
  Symbols s;
  const auto &x = s.x, &y = s.y;
  const Expr zero = s.g.zero(), one = s.g.one();
  const auto above = [&](Expr u, Expr then, Expr otherwise) { return select(-u, otherwise, then); };  // u > 0
  EXPECT_TRUE(s.shown(select(x, x, -x) - abs(x)));
  EXPECT_TRUE(s.shown(above(x, x, -x) - abs(x)));
  EXPECT_TRUE(s.shown(above(x, one, above(-x, -one, zero)) - sign(x)));
  EXPECT_TRUE(s.shown(select(x - y, x, y) - Rational(1, 2) * (x + y + abs(x - y))));
  EXPECT_TRUE(s.shown(select(2 * x - 2 * y, x, y) + select(y - x, x, y) - x - y));
  EXPECT_TRUE(s.shown(select(x, x * x, zero) + select(-x, x * x, zero) - x * x));
  EXPECT_TRUE(s.shown(select(x, log(x * x), 2 * log(-x)) - 2 * log(abs(x))));
  // The mutants; the first differs at x = 0.
  EXPECT_FALSE(s.shown(above(x, one, -one) - sign(x)));
  EXPECT_FALSE(s.shown(select(x, one, -one) - sign(x)));
  EXPECT_FALSE(s.shown(select(x, x, -x) - x));
  EXPECT_FALSE(s.shown(select(x - y, x, y) - Rational(1, 2) * (x + y - abs(x - y))));
  EXPECT_FALSE(s.shown(select(x, x + y, y - x) - abs(x)));
}

// The mutants: each holds for one sign only, or differs by a term.
TEST(FewFunctions, DoNotShowWhatDiffers) {
  const Symbols s;
  const auto &x = s.x, &y = s.y;
  EXPECT_FALSE(s.shown(abs(x) - x));
  EXPECT_FALSE(s.shown(sqrt(x * x) - x));
  EXPECT_FALSE(s.shown(pow(sign(x), 2) - 1));  // not at zero
  EXPECT_FALSE(s.shown(sign(x) * x * x - x * x));
  EXPECT_FALSE(s.shown(sqrt(x * x * y * y) - x * y));
  EXPECT_FALSE(s.shown(abs(x + y) - abs(x) - abs(y)));
  EXPECT_FALSE(s.shown(exp(x + y) - exp(x) * exp(2 * y)));
  EXPECT_FALSE(s.shown(pow(cosh(x), 2) + pow(sinh(x), 2) - 1));
  EXPECT_FALSE(s.shown(log(x * x) - 2 * log(x) + y));
  const Expr third = Rational(1, 3) * s.turn, root3 = sqrt(s.number(3));
  EXPECT_FALSE(s.shown(2 * sin(x + third) - sin(x) + root3 * cos(x)));
  EXPECT_FALSE(s.shown(tan(x + Rational(1, 2) * s.turn) - tan(x)));
  EXPECT_FALSE(s.shown(sqrt(s.number(6)) - sqrt(s.number(2)) - root3));
}

}  // namespace
}  // namespace anholon::few_functions_test
