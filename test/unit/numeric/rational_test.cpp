#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "numeric/multiples.h"
#include "numeric/number.h"
#include "numeric/rational.h"

namespace anholon::rational_test {
namespace {

TEST(Rational, NearestDouble) {
  for (const char* const text :
       {"9.81", "0.2", "-0.7", "0.1", "1/3", "2/3", "-22/7", "1e-30", "123456789012345678901/7"})
    EXPECT_EQ(parse_rational(text)->get_d(), from_rational<double>(*parse_rational(text))) << text;
  EXPECT_EQ(parse_rational("9.81")->get_d(), 9.81);
  EXPECT_EQ(parse_rational("0.2")->get_d(), 0.2);
}

TEST(Rational, ExactTextIfShort) {
  const std::pair<const char*, const char*> cases[] = {{"9.81", "9.81"},
                                                       {"-0.2", "-0.2"},
                                                       {"3", "3"},
                                                       {"1e-30", "1e-30"},
                                                       {"5/18", "5/18"},
                                                       {"-1/3", "-1/3"},
                                                       {"1e300", "1e+300"},
                                                       {"0", "0"},
                                                       {"0.12345678901234567891", "0.12345678901234567891"},
                                                       {"-1234567890.12345678901", "-1234567890.12345678901"}};
  for (const auto& [number, text] : cases) EXPECT_EQ(exact_text_if_short(*parse_rational(number)), text);
  EXPECT_EQ(exact_text_if_short(Rational(1) / (exact_power(Rational(7), 80).value())), number_text(std::pow(7.0, -80)));
}

// Integers near the sizes at which a number needs memory of its own, and at which `long` ends.
std::vector<mpz_class> remarkable_integers() {
  std::vector<mpz_class> list{0, 1, 2, 3, 12, 997};
  for (unsigned bits : {31U, 32U, 61U, 62U, 63U, 64U, 130U})
    for (int d : {-1, 0, 1}) list.push_back((mpz_class(1) << bits) + d);
  const std::size_t positive = list.size();
  for (std::size_t k = 0; k < positive; ++k) list.push_back(-list[k]);
  return list;
}

std::vector<mpq_class> remarkable_fractions() {
  std::vector<mpq_class> list;
  const std::vector<mpz_class> n = remarkable_integers();
  for (const mpz_class& p : n) list.emplace_back(p);
  for (std::size_t k = 0; k < n.size(); ++k) {
    mpq_class r(n[k], abs(n[(5 * k + 3) % n.size()]) + 1);
    r.canonicalize();
    list.push_back(r);
  }
  return list;
}

// Compares the arithmetic of a and b with that of GMP. Returns the name of the first difference, or an empty text.
std::string fault(const mpq_class& a, const mpq_class& b) {
  const Rational x = Rational::from(a), y = Rational::from(b);
  const auto differs = [](const Rational& r, const mpq_class& exact) { return r.get_mpq() != exact; };
  if (differs(x + y, a + b)) return "sum";
  if (differs(x - y, a - b)) return "difference";
  if (differs(x * y, a * b)) return "product";
  if (b != 0 && differs(x / y, a / b)) return "quotient";
  if (differs(-x, -a) || differs(abs(x), abs(a))) return "sign";
  if ((x < y) != (a < b) || (x == y) != (a == b) || sgn(x) != sgn(a) || (x > 3) != (a > 3) || (x == -1) != (a == -1))
    return "comparison";
  if (x.get_num() != a.get_num() || x.get_den() != a.get_den()) return "parts";
  if (x.get_str() != a.get_str() || x.get_str(62) != a.get_str(62) || x.get_d() != from_rational<double>(x))
    return "text or double";
  if (x.is_integer() != (a.get_den() == 1) ||
      x.fits_long() != (a.get_num().fits_slong_p() && a.get_den().fits_slong_p()))
    return "size";
  if (x.fits_long() && x.to_long() != a.get_num().get_si()) return "to_long";
  if (x == y && x.hash() != y.hash()) return "hash";
  const mpz_class common_den = lcm(a.get_den(), b.get_den()), common_num = gcd(a.get_num(), b.get_num());
  mpq_class common(common_num, common_den);
  common.canonicalize();
  if (differs(gcd(x, y), common)) return "gcd";
  mpz_class below;
  mpz_fdiv_q(below.get_mpz_t(), a.get_num_mpz_t(), a.get_den_mpz_t());
  if (differs(floor(x), below)) return "floor";
  return "";
}

TEST(RationalNumber, HasTheArithmeticOfGmpForNumbersOfAllSizes) {
  const std::vector<mpq_class> list = remarkable_fractions();
  for (const mpq_class& a : list)
    for (const mpq_class& b : list) EXPECT_EQ(fault(a, b), "") << a << " and " << b;
}

TEST(RationalNumber, IsInLowestTermsWithAPositiveDenominator) {
  EXPECT_EQ(Rational(6, -4).get_str(), "-3/2");
  EXPECT_EQ(Rational(-6, -4), Rational(3, 2));
  EXPECT_EQ(Rational(0, -7).get_den(), 1);
  EXPECT_EQ(Rational("10/4"), Rational(5, 2));
  EXPECT_EQ(Rational(std::numeric_limits<long>::min()).get_str(), "-9223372036854775808");
  EXPECT_EQ(Rational(std::numeric_limits<unsigned long>::max()).get_str(), "18446744073709551615");
}

TEST(RationalNumber, SurvivesMovesAndAssignmentsToItself) {
  const mpz_class large = (mpz_class(1) << 200) + 1;
  Rational a(large, 3), b = std::move(a);
  EXPECT_EQ(b, Rational(large, 3));
  a = b;
  EXPECT_EQ(a, b);
  a += a, a -= b, a *= a, a /= a;
  EXPECT_EQ(a, 1);
}

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
    return Rational::from(q);
  };
  const Rational miss = abs(exact(x) - r);
  const N infinity = std::numeric_limits<N>::infinity();
  return miss <= abs(exact(std::nextafter(x, infinity)) - r) && miss <= abs(exact(std::nextafter(x, -infinity)) - r);
}

TEST(FromRational, IsCorrectlyRounded) {
  for (long p = -40; p <= 40; p += 3)
    for (long q : {1L, 3L, 7L, 10L, 997L, 1000003L}) {
      Rational r(p, q);
      r *= r * r;
      EXPECT_TRUE(is_nearest(from_rational<double>(r), r)) << r;
      EXPECT_TRUE(is_nearest(from_rational<long double>(r), r)) << r;
    }
  const Rational large = *exact_power(Rational(10), 300) / 7, small = 1 / large;
  EXPECT_TRUE(is_nearest(from_rational<double>(large), large));
  EXPECT_TRUE(is_nearest(from_rational<double>(small), small));
  // A number half way between two doubles, and one just above it: there may be only one rounding.
  const Rational ulp = 1 / *exact_power(Rational(2), 52), tie = 1 + ulp / 2, above = tie + ulp / 1000000;
  EXPECT_EQ(from_rational<double>(tie), 1.0);
  EXPECT_EQ(from_rational<double>(above), 1.0 + 0x1p-52);
}

TEST(FromRational, TruncationWouldBeNoticed) {
  const Rational r(1, 10);
  EXPECT_FALSE(is_nearest(r.get_mpq().get_d(), r)) << "the mutant of the test above: GMP truncates";
}

TEST(Multiples, AreTheNearestNumbers) {
  for (const mpq_class& q : remarkable_fractions()) {
    const Rational of(q.get_num(), q.get_den());
    const Multiples<double> doubles(of);
    const Multiples<long double> wide(of);
    for (const long k : {0L, 1L, 2L, 3L, 99'999L, (1L << 53) + 1, std::numeric_limits<long>::max()}) {
      const Rational multiple = k * of;
      EXPECT_EQ(doubles(k), from_rational<double>(multiple)) << k << " times " << of;
      EXPECT_EQ(wide(k), from_rational<long double>(multiple)) << k << " times " << of;
      EXPECT_TRUE(is_nearest(wide(k), multiple)) << k << " times " << of;
    }
  }
}

}  // namespace
}  // namespace anholon::rational_test
