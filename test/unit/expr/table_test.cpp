// Tables are compared with their definition: values at knots, derivatives by differences, the smoothness of each fit;
// monotone data stay monotone.
#include <gtest/gtest.h>

#include "expr/diff.h"
#include "expr/table.h"
#include "support/value.h"

namespace anholon::table_test {
namespace {

const Table kTable{"F", {0, 1, Rational(5, 2), 3, 5}, {0, 2, 2, -1, 4}, Fit::linear, Outside::hold};

Table with(Fit fit, Outside outside = Outside::hold) {
  Table t = kTable;
  t.fit = fit;
  t.outside = outside;
  return t;
}

// F and its derivatives by x, at x.
struct Function {
  Graph g;
  Expr x = g.time(), f;
  explicit Function(const Table& t) : f(TableFunction(g, t)(x)) {}
  double operator()(double at, int derivative = 0) const {
    const PrecisionScope precision(40);
    Expr d = f;
    for (int k = 0; k < derivative; ++k) d = total_derivative(d);
    return to_double(test::value(d, test::Point().set(x, Multi(at))));
  }
};

TEST(Tables, GoThroughTheirKnots) {
  for (Fit fit : {Fit::hold, Fit::linear, Fit::monotone, Fit::spline}) {
    const Function f(with(fit));
    for (std::size_t k = 0; k < kTable.x.size(); ++k)
      EXPECT_NEAR(f(kTable.x[k].get_d()), kTable.y[k].get_d(), 1e-14) << smoothness(fit);
  }
  EXPECT_EQ(Function(with(Fit::hold))(2.4), 2);
  EXPECT_EQ(Function(with(Fit::hold))(-1), 0);
  EXPECT_NEAR(Function(with(Fit::linear))(2.75), 0.5, 1e-15);
}

TEST(Tables, HaveTheDerivativesOfDifferences) {
  constexpr double kStep = 1e-6;
  for (Fit fit : {Fit::hold, Fit::linear, Fit::monotone, Fit::spline}) {
    const Function f(with(fit));
    for (double x : {-0.5, 0.3, 1.7, 2.7, 4.2, 6.0})
      for (int k : {1, 2, 3})
        EXPECT_NEAR(f(x, k), (f(x + kStep, k - 1) - f(x - kStep, k - 1)) / (2 * kStep), 1e-7)
            << smoothness(fit) << " " << x << " " << k;
  }
}

TEST(Tables, AreAsSmoothAsTheirFitSays) {
  constexpr double kNear = 1e-9;
  for (Fit fit : {Fit::hold, Fit::linear, Fit::monotone, Fit::spline}) {
    const Function f(with(fit));
    double jump[4] = {0, 0, 0, 0};
    for (std::size_t i = 1; i + 1 < kTable.x.size(); ++i)
      for (int k = 0; k < 4; ++k)
        jump[k] = std::max(jump[k], std::abs(f(kTable.x[i].get_d() + kNear, k) - f(kTable.x[i].get_d() - kNear, k)));
    for (int k = 0; k < 4; ++k) {
      if (k <= smoothness(fit)) {
        EXPECT_LT(jump[k], 1e-6) << "derivative " << k << " of fit " << smoothness(fit);
      } else if (k == smoothness(fit) + 1) {
        EXPECT_GT(jump[k], 1e-2) << "no more than that";
      }
    }
  }
}

TEST(Tables, BeyondTheirKnots) {
  for (Fit fit : {Fit::linear, Fit::monotone, Fit::spline}) {
    const Function held(with(fit)), on(with(fit, Outside::linear));
    EXPECT_EQ(held(7), 4);
    EXPECT_EQ(held(-3), 0);
    EXPECT_NEAR(on(7), 4 + 2 * on(4.9999999, 1), 1e-6) << "along the tangent";
    EXPECT_NEAR(on(-3), -3 * on(1e-8, 1), 1e-6);
  }
}

TEST(Tables, MonotoneStaysMonotone) {
  const Function monotone({"M", {0, 1, 2, 3, 10, 11}, {0, 1, 1, 50, 51, 51}, Fit::monotone, Outside::hold});
  const Function spline({"M", {0, 1, 2, 3, 10, 11}, {0, 1, 1, 50, 51, 51}, Fit::spline, Outside::hold});
  bool overshoots = false;
  for (int k = 1; k <= 1100; ++k) {
    EXPECT_GE(monotone(k / 100.0) - monotone((k - 1) / 100.0), -1e-14) << k;
    overshoots = overshoots || spline(k / 100.0) < spline((k - 1) / 100.0) - 1e-6;
  }
  EXPECT_TRUE(overshoots) << "the values above would not tell a fit that overshoots";
}

TEST(Tables, SayWhenTheyAreTooRough) {
  for (Fit fit : {Fit::hold, Fit::linear, Fit::monotone, Fit::spline}) {
    const Function f(with(fit));
    for (int k = 0; k <= 4; ++k)
      EXPECT_EQ(too_rough(f.f, k).has_value(), k > smoothness(fit) + 1) << smoothness(fit) << " " << k;
    EXPECT_EQ(too_rough(total_derivative(f.f), 1).has_value(), 2 > smoothness(fit) + 1 && fit != Fit::hold)
        << smoothness(fit);
  }
}

}  // namespace
}  // namespace anholon::table_test
