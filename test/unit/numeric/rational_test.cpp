#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "numeric/number.h"
#include "numeric/rational.h"

namespace anholon::rational_test {
namespace {

TEST(ParseRational, DecimalsAreExact) {
  EXPECT_EQ(*parse_rational("3"), Rational(3));
  EXPECT_EQ(*parse_rational("-0.25"), Rational(-1, 4));
  EXPECT_EQ(*parse_rational("1e-3"), Rational(1, 1000));
  EXPECT_EQ(*parse_rational("22/7"), Rational(22, 7));
  EXPECT_EQ(*parse_rational(".5"), Rational(1, 2));
  EXPECT_EQ(*parse_rational("5."), Rational(5));
  EXPECT_EQ(*parse_rational("+2.50E+1"), Rational(25));
  EXPECT_EQ(*parse_rational("007"), Rational(7)) << "decimal, not octal";
  EXPECT_EQ(*parse_rational("-0"), Rational(0));
  EXPECT_EQ(*parse_rational("0.1"), Rational(1, 10)) << "not the double nearest to it";
}

TEST(ParseRational, RefusesWhatIsNoNumber) {
  for (const char* text : {"",      "-",   "+",   ".",  "e5", "1e",  "1e+", "1.2.3", "0x10", "1/0",  "1/",   "/2",
                           "1/2/3", "--1", "+-1", " 1", "1 ", "1,5", "inf", "nan",   "1e5x", "1e 5", "1e+-5"})
    EXPECT_FALSE(parse_rational(text)) << "'" << text << "'";
}

TEST(ParseRational, RefusesAbsurdSizesAndKeepsLargeOnes) {
  EXPECT_TRUE(parse_rational("1e5000"));
  EXPECT_FALSE(parse_rational("1e5001"));
  EXPECT_FALSE(parse_rational("1e-5001"));
  EXPECT_FALSE(parse_rational("1e99999999999999999999999"));
  EXPECT_FALSE(parse_rational(std::string(5001, '7')));
  EXPECT_EQ(to_string(*parse_rational(std::string(5000, '7'))), std::string(5000, '7'));
}

TEST(ParseRational, ReadsBackWhatToStringWrites) {
  for (const Rational& r : {Rational(0), Rational(-1, 4), Rational(22, 7), Rational(1000000007)})
    EXPECT_EQ(*parse_rational(to_string(r)), r);
}

TEST(ExactRoot, IsTheRootWhereItIsRational) {
  EXPECT_EQ(*exact_root(Rational(9, 4), 2), Rational(3, 2));
  EXPECT_EQ(*exact_root(Rational(-8, 27), 3), Rational(-2, 3));
  EXPECT_FALSE(exact_root(Rational(2), 2));
  EXPECT_FALSE(exact_root(Rational(9, 5), 2));
  EXPECT_FALSE(exact_root(Rational(-4), 2));
}

TEST(ExactPower, RefusesZeroToANegativePowerAndAbsurdSizes) {
  EXPECT_EQ(*exact_power(Rational(-2, 3), -3), Rational(-27, 8));
  EXPECT_EQ(*exact_power(Rational(0), 0), Rational(1));
  EXPECT_FALSE(exact_power(Rational(0), -1));
  EXPECT_FALSE(exact_power(Rational(3), 1000000));
  EXPECT_TRUE(exact_power(Rational(1, 2), 1000));
}

// |x - r| <= |x - y| for both neighbours y of x, in exact arithmetic.
template <class N>
bool is_nearest(N x, const Rational& r) {
  const auto exact = [](N y) {
    const PrecisionScope precision(60);
    mpq_class q;
    mpfr_get_q(q.get_mpq_t(), Multi(static_cast<long double>(y)).raw());
    return q;
  };
  const Rational miss = ::abs(exact(x) - r);
  const N infinity = std::numeric_limits<N>::infinity();
  return miss <= ::abs(exact(std::nextafter(x, infinity)) - r) &&
         miss <= ::abs(exact(std::nextafter(x, -infinity)) - r);
}

TEST(FromRational, IsCorrectlyRounded) {
  for (long p = -40; p <= 40; p += 3)
    for (long q : {1L, 3L, 7L, 10L, 997L, 1000003L}) {
      Rational r(p, q);
      r.canonicalize();
      r *= r * r;
      EXPECT_TRUE(is_nearest(from_rational<double>(r), r)) << r;
      EXPECT_TRUE(is_nearest(from_rational<long double>(r), r)) << r;
    }
  const Rational large = *exact_power(Rational(10), 300) / 7, small = 1 / large;
  EXPECT_TRUE(is_nearest(from_rational<double>(large), large));
  EXPECT_TRUE(is_nearest(from_rational<double>(small), small));
  // Half way between two doubles, and just above it: only one rounding may happen on the way.
  const Rational ulp = 1 / *exact_power(Rational(2), 52), tie = 1 + ulp / 2, above = tie + ulp / 1000000;
  EXPECT_EQ(from_rational<double>(tie), 1.0);
  EXPECT_EQ(from_rational<double>(above), 1.0 + 0x1p-52);
}

TEST(FromRational, TruncationWouldBeNoticed) {
  const Rational r(1, 10);
  EXPECT_FALSE(is_nearest(mpq_get_d(r.get_mpq_t()), r)) << "the mutant of the test above: GMP truncates";
}

}  // namespace
}  // namespace anholon::rational_test
