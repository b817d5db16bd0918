#include <gtest/gtest.h>

#include "expr/degree.h"
#include "expr/diff.h"
#include "expr/normal.h"
#include "expr/refute.h"
#include "print/print.h"
#include "support/plain_names.h"
#include "support/random_expr.h"

namespace anholon::refute_test {
namespace {

using test::PlainNames;

TEST(Refute, LeavesIdentitiesAlone) {
  PlainNames n;
  for (const char* text : {"sin(x)^2 + cos(x)^2 - 1", "cos(x - y + a) - cos(x + a)*cos(y) - sin(x + a)*sin(y)",
                           "sin(3*x/4) - 3*sin(x/4) + 4*sin(x/4)^3", "tan(x)*cos(x) - sin(x)",
                           "sqrt(x^2 + y^2)^2 - x^2 - y^2", "(x + y)^(5/3)*(x + y)^(-2/3) - x - y",
                           "1/sqrt(1 + x^2) - sqrt(1 + x^2)/(1 + x^2)", "((x^2 + y)^(1/6))^6 - x^2 - y",
                           "sqrt(2)*sqrt(x + 1)*sqrt(2) - 2*sqrt(x + 1)", "log(x)*(x + 1) - log(x) - x*log(x)", "0"})
    EXPECT_FALSE(refuted(n.number(text))) << text;
}

TEST(Refute, FindsWhatIsNotZero) {
  PlainNames n;
  for (const char* text :
       {"1", "x", "x - y", "sin(x)^2 + cos(x)^2 - 2", "sin(x)^2 - cos(x)^2 - 1",
        "sin(x + y) - sin(x)*cos(y) + cos(x)*sin(y)", "sin(2*x) - 2*sin(x)", "sin(3*x/4) - 3*sin(x/4) + 3*sin(x/4)^3",
        "sqrt(x^2 + y^2)^2 - x^2 - y", "1/sqrt(1 + x^2) - sqrt(1 + x^2)/(2 + x^2)", "x'' - x'",
        "(x + y)^(1/3) - (x + y)^(2/3)", "log(x) - log(y)", "1000000007/1000000009*x - x", "atan2(y, x) - atan(y/x)"})
    EXPECT_TRUE(refuted(n.number(text))) << text;
}

// A refutation never contradicts a proof, and nearly always succeeds.
TEST(Refute, AgreesWithTheProofOfRandomExpressions) {
  PlainNames n;
  const std::vector<Expr> atoms = {n.number("x"), n.number("y"), n.number("a"), n.number("x'")};
  int found = 0, asked = 0;
  for (std::uint32_t k = 1; k <= 150; ++k) {
    test::RandomExpr make(n.g, k, atoms);
    const Expr u = make.make(2), v = make.make(2), w = make.make(1);
    const Expr same[] = {(u + v) * w - u * w - v * w, (u + v) * (u - v) - u * u + v * v,
                         sin(u + w) - sin(u) * cos(w) - cos(u) * sin(w)};
    for (Expr zero : same) {
      EXPECT_FALSE(refuted(zero)) << print(zero, {}, Format::text);
      found += refuted(zero + make.coefficient() * make.atom());
      ++asked;
    }
  }
  EXPECT_GT(found, asked * 9 / 10);
}

// Euler's theorem: sum x df/dx = k f.
TEST(Degree, EulersTheoremHolds) {
  PlainNames n;
  const auto rate = [](const Node& node) { return node.kind == Kind::jet && node.order == 1; };
  const Column rates = {n.number("x'"), n.number("y'")};
  const auto misses = [&](Expr f, const Rational& k) {
    const Column d = gradient(f, rates);
    return !proved_zero(rates[0] * d[0] + rates[1] * d[1] - k * f);
  };
  for (const auto& [text, degree] : {std::pair{"sin(x)*x' - cos(y)*y'", Rational(1)},
                                     {"sqrt(x'^2 + a*y'^2)", Rational(1)},
                                     {"x'*y'/(x' + y')", Rational(1)},
                                     {"x'^2*y' + a*y'^3", Rational(3)},
                                     {"sin(x'/y')*y'", Rational(1)},
                                     {"x + a", Rational(0)},
                                     {"1/x'", Rational(-1)}}) {
    const auto found = homogeneous_degree(n.number(text), rate);
    ASSERT_TRUE(found) << text;
    EXPECT_EQ(*found, degree) << text;
    EXPECT_FALSE(misses(n.number(text), degree)) << text;
    EXPECT_TRUE(misses(n.number(text), degree + 1)) << text;
  }
  for (const char* text : {"x' + 1", "x'*y' + y'", "sin(x')", "atan2(x', 1)", "sign(x')*x"})
    EXPECT_FALSE(homogeneous_degree(n.number(text), rate)) << text;
}

}  // namespace
}  // namespace anholon::refute_test
