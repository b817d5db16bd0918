#include <gtest/gtest.h>

#include "expr/antiderivative.h"
#include "expr/normal.h"
#include "support/plain_names.h"

namespace anholon::antiderivative_test {
namespace {

using test::PlainNames;

TEST(Antiderivative, OfItsTable) {
  PlainNames n;
  const Expr x = n.number("x");
  for (const char* text : {"3",
                           "y",
                           "x^3*y",
                           "1/x",
                           "sqrt(x)",
                           "(a*x + b)^3",
                           "1/(a*x + b)",
                           "sin(a*x + y)",
                           "cos(2*x)*y",
                           "exp(-a*x)",
                           "tan(x)",
                           "sinh(x)",
                           "x*sin(x)",
                           "x^3*exp(a*x)",
                           "sin(x)^2",
                           "cos(a*x)^2",
                           "1/cos(x)^2",
                           "sin(x)*cos(x)",
                           "sin(x)*cos(x)^4",
                           "x/(1 + x^2)",
                           "x*sqrt(a + x^2)",
                           "log(x)",
                           "(x + y)/x",
                           "x*(1 + sin(x))",
                           "exp(x)*exp(x)",
                           "1/(1 + x^2)",
                           "a/(4*x^2 + 9)",
                           "y/(x^2 + y^2)"}) {
    const std::optional<Expr> F = antiderivative(n.number(text), x);
    ASSERT_TRUE(F) << text;
    EXPECT_TRUE(proved_zero(partial(*F, x) - n.number(text))) << text;
  }
}

TEST(Antiderivative, SaysNothingBeyondIt) {
  PlainNames n;
  const Expr x = n.number("x");
  for (const char* text : {"exp(x^2)", "sin(x)/x", "sin(x^2)", "sqrt(1 + x^3)", "1/log(x)"})
    EXPECT_FALSE(antiderivative(n.number(text), x)) << text;
}

TEST(Potential, OfClosedForms) {
  PlainNames n;
  const Column z = {n.number("x"), n.number("y"), n.number("t")};
  const auto form = [&](const char* by_x, const char* by_y, const char* by_t) {
    return potential({n.number(by_x), n.number(by_y), n.number(by_t)}, z);
  };
  const std::optional<Expr> f = form("y*cos(t)", "x*cos(t) + 2*y", "-x*y*sin(t)");
  ASSERT_TRUE(f);
  EXPECT_TRUE(proved_zero(*f - n.number("x*y*cos(t) + y^2")));
  EXPECT_FALSE(form("y*cos(t)", "x*cos(t) + 2*y", "x*y*sin(t)"));  // not closed
  EXPECT_FALSE(form("-y", "x", "0"));
}

TEST(Exponential, MakesLogarithmsPowers) {
  PlainNames n;
  EXPECT_EQ(exponential(n.number("2*log(x) - y")), n.number("x^2*exp(-y)"));
  EXPECT_EQ(exponential(n.number("log(x) - log(y)")), n.number("x/y"));
  EXPECT_EQ(exponential(n.number("-log(x)")), n.number("1/x"));
}

}  // namespace
}  // namespace anholon::antiderivative_test
