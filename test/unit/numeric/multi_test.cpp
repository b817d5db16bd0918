#include <thread>

#include <gtest/gtest.h>

#include "numeric/multi.h"
#include "numeric/number.h"

namespace anholon::multi_test {
namespace {

TEST(Multi, KnowsDigitsOfPiAndRoots) {
  const PrecisionScope precision(50);
  EXPECT_EQ(pi<Multi>().to_string(45), "3.14159265358979323846264338327950288419716940e+00");
  EXPECT_EQ(sqrt(Multi(2)).to_string(45), "1.41421356237309504880168872420969807856967188e+00");
  EXPECT_EQ(exp(Multi(1)).to_string(45), "2.71828182845904523536028747135266249775724709e+00");
}

TEST(Multi, ThirdsAreExactToThePrecision) {
  const PrecisionScope precision(40);
  const Multi third = Multi(1) / Multi(3);
  EXPECT_LE(to_double(abs(Multi(third * Multi(3) - Multi(1)))), 1e-40);
  EXPECT_GT(to_double(abs(Multi(Multi(1.0 / 3) * Multi(3) - Multi(1)))), 1e-20) << "a double would be seen";
}

TEST(Multi, ComparesAndMovesLikeANumber) {
  Multi a(2), b(3);
  EXPECT_TRUE(a < b && b > a && a <= a && a >= a && a == Multi(2) && !(a == b));
  Multi c = std::move(a);
  a = b;
  b = Multi(7);
  EXPECT_TRUE(c == Multi(2) && a == Multi(3) && b == Multi(7));
  c = *&c;
  EXPECT_TRUE(c == Multi(2));
  EXPECT_FALSE((Multi(1) / Multi(0)).finite());
  EXPECT_FALSE(sqrt(Multi(-1)).finite());
  EXPECT_FALSE(sqrt(Multi(-1)) < Multi(0) || sqrt(Multi(-1)) >= Multi(0)) << "not a number is not ordered";
}

TEST(PrecisionScope, HoldsForItsLifetimeAndNests) {
  const mpfr_prec_t before = Multi::working_bits();
  {
    const PrecisionScope outer(100);
    const mpfr_prec_t bits = Multi::working_bits();
    EXPECT_GE(bits, 333);  // 100 log2(10) = 332.2
    {
      const PrecisionScope inner(20);
      EXPECT_LT(Multi::working_bits(), bits);
    }
    EXPECT_EQ(Multi::working_bits(), bits);
  }
  EXPECT_EQ(Multi::working_bits(), before);
}

TEST(PrecisionScope, BelongsToItsThread) {
  const PrecisionScope precision(200);
  const mpfr_prec_t mine = Multi::working_bits();
  mpfr_prec_t theirs = mine;
  std::thread([&] { theirs = Multi::working_bits(); }).join();
  EXPECT_NE(theirs, mine);
}

TEST(UnitRoundoff, IsTheLargestThatOneDoesNotNotice) {
  const PrecisionScope precision(30);
  const Multi u = unit_roundoff<Multi>();
  EXPECT_TRUE(Multi(1) + u == Multi(1));
  EXPECT_FALSE(Multi(1) + u * Multi(1.5) == Multi(1));
  EXPECT_EQ(1.0 + unit_roundoff<double>(), 1.0);
  EXPECT_NE(1.0 + 1.5 * unit_roundoff<double>(), 1.0);
}

TEST(NumberText, ReadsBackToTheSameNumber) {
  for (double x : {0.1, 1.0 / 3, 1e300, 5e-324, -0.0, 123456789.0})
    EXPECT_EQ(std::strtod(number_text(x).c_str(), nullptr), x);
  for (long double x : {0.1L, 1.0L / 3, 1e-4000L}) EXPECT_EQ(std::strtold(number_text(x).c_str(), nullptr), x);
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(1.0 / 0.0), "inf");
  EXPECT_EQ(number_text(std::nan("")), "nan");
}

TEST(AddMul, RoundsAfterTheProductInEveryType) {
  // With one rounding (fused) the result would be the round-off of the product, not 0.
  const double a = 1 + 0x1p-30;
  double s = -(a * a);
  addmul(s, a, a);
  EXPECT_EQ(s, 0.0);
  const PrecisionScope precision(20);
  const Multi b = Multi(1) / Multi(3), square = b * b;
  Multi t = -square;
  addmul(t, b, b);
  EXPECT_TRUE(t == Multi(0));
}

}  // namespace
}  // namespace anholon::multi_test
