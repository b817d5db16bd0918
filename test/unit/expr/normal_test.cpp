#include <gtest/gtest.h>

#include "expr/normal.h"
#include "print/print.h"
#include "support/plain_names.h"
#include "support/random_expr.h"
#include "support/value.h"

namespace anholon::normal_test {
namespace {

using test::PlainNames;

TEST(ProvedZero, KnowsTheIdentitiesOfItsPurpose) {
  PlainNames n;
  for (const char* text : {
           "sin(x)^2 + cos(x)^2 - 1",
           "sin(2*x) - 2*sin(x)*cos(x)",
           "cos(2*x) - 1 + 2*sin(x)^2",
           "sin(x + y) - sin(x)*cos(y) - cos(x)*sin(y)",
           "cos(x - y + a) - cos(x + a)*cos(y) - sin(x + a)*sin(y)",
           "sin(3*x) - 3*sin(x) + 4*sin(x)^3",
           "sin(x/2)^2 - (1 - cos(x))/2",
           "sqrt(x^2 + y^2)^2 - x^2 - y^2",
           "1/sqrt(1 + x^2) - sqrt(1 + x^2)/(1 + x^2)",
           "(x^2 - y^2)/(x - y) - x - y",
           "1/(x - 1) - 1/(x + 1) - 2/(x^2 - 1)",
           "(x + y)^5 - x^5 - 5*x^4*y - 10*x^3*y^2 - 10*x^2*y^3 - 5*x*y^4 - y^5",
           "(a*x + b)^2/a - a*x^2 - 2*b*x - b^2/a",
       })
    EXPECT_TRUE(proved_zero(n.number(text))) << text;
}

TEST(ProvedZero, ClaimsNothingFalse) {
  PlainNames n;
  for (const char* text :
       {"sin(x)^2 + cos(x)^2 - 2", "sin(2*x) - 2*sin(x)", "sqrt(x^2) - x", "abs(x) - x", "sqrt(x^2*y^2) - x*y",
        "sin(x + y) - sin(x) - sin(y)", "sqrt(x + y) - sqrt(x) - sqrt(y)", "x - y", "exp(x*y) - exp(x)*exp(y)",
        "atan2(y, x) - atan(y/x)", "acos(cos(x)) - x", "sign(x) - 1", "log(x^2) - 2*log(x)", "x'' - x'", "1"})
    EXPECT_FALSE(proved_zero(n.number(text))) << text;
}

// e - e written in another way is zero; with a term that is zero nowhere it must never be called zero.
TEST(ProvedZero, SeesEveryRandomPerturbation) {
  const PrecisionScope precision(50);
  PlainNames n;
  const std::vector<Expr> atoms = {n.number("x"), n.number("y"), n.number("a"), n.number("x'")};
  int proofs = 0;
  for (std::uint32_t k = 1; k <= 150; ++k) {
    test::RandomExpr make(n.g, k, atoms);
    const Expr u = make.make(2), v = make.make(2), w = make.make(1);
    const Expr same[] = {(u + v) * w - u * w - v * w, (u + v) * (u - v) - u * u + v * v,
                         sin(u + w) - sin(u) * cos(w) - cos(u) * sin(w)};
    for (Expr zero : same) {
      const Expr perturbed = zero + make.coefficient() * make.atom();
      const Multi size = abs(test::value(perturbed, test::Point(k)));
      ASSERT_GT(to_double(size), 1e-10) << "the point is not fit for this test";
      ASSERT_FALSE(proved_zero(perturbed)) << print(perturbed, {}, Format::text);
      proofs += proved_zero(zero);
    }
  }
  EXPECT_GT(proofs, 400) << "of 450 identities, which hold by algebra and angle sums alone";
}

// Random expressions near zero: two of them are equal only if their values are.
TEST(ProvedZero, NeverHoldsForWhatIsNumericallyNotZero) {
  const PrecisionScope precision(50);
  PlainNames n;
  const std::vector<Expr> atoms = {n.number("x"), n.number("y"), n.number("a")};
  for (std::uint32_t k = 1; k <= 200; ++k) {
    test::RandomExpr make(n.g, 500 + k, atoms);
    const Expr e = make.make(3) - make.make(3);
    if (!proved_zero(e)) continue;
    ASSERT_LE(to_double(abs(test::value(e, test::Point(k)))), 1e-40) << print(e, {}, Format::text);
  }
}

TEST(Expanded, HasTheSameValue) {
  const PrecisionScope precision(60);
  const double tolerance = 1e-35;  // 60 digits, and cancellation between monomials of moderate size
  PlainNames n;
  const std::vector<Expr> atoms = {n.number("x"),  n.number("y"),      n.number("a"),
                                   n.number("x'"), sin(n.number("x")), sqrt(n.number("1 + y^2"))};
  int written_out = 0;
  for (std::uint32_t k = 1; k <= 150; ++k) {
    const Expr e = test::RandomExpr(n.g, 900 + k, atoms).make(3);
    const std::optional<Expr> f = expanded(e);
    if (!f) continue;
    ++written_out;
    ASSERT_LE(test::distance(test::value(e, test::Point(k)), test::value(*f, test::Point(k))), tolerance)
        << print(e, {}, Format::text);
  }
  EXPECT_GT(written_out, 100);
}

TEST(Expanded, IsASumOfMonomials) {
  PlainNames n;
  EXPECT_EQ(*expanded(n.number("(x + a)^2")), n.number("x^2 + 2*a*x + a^2"));
  EXPECT_EQ(*expanded(n.number("x*(x' + y*a) - x*y*a")), n.number("x*x'"));
  EXPECT_TRUE(is_zero(*expanded(n.number("sin(x)^2 + cos(x)^2 - 1"))));
}

}  // namespace
}  // namespace anholon::normal_test
