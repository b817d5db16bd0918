#include <cmath>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "numeric/ball.h"
#include "numeric/number.h"
#include "numeric/quad.h"

namespace anholon::quad_test {
namespace {

Multi multi(Quad x) {
  Multi r;
  set_mpfr(r.raw(), x);
  return r;
}

// The error in round-offs of the exact value.
double roundoffs(Quad x, const Multi& exact) {
  return to_double(Multi(abs(Multi(multi(x) - exact)) / abs(exact))) / to_double(unit_roundoff<Quad>());
}

class Quads : public testing::Test {
 protected:
  PrecisionScope precision{60};
};

TEST_F(Quads, HaveTheDigitsOfPiAndOfAThird) {
  EXPECT_EQ(number_text(pi<Quad>(), 34), "3.141592653589793238462643383279503");
  EXPECT_EQ(number_text(from_rational<Quad>(Rational(1, 3)), 33), "0.333333333333333333333333333333333");
  EXPECT_LE(roundoffs(from_rational<Quad>(Rational(1, 3)), Multi(Rational(1, 3))), 1);
  EXPECT_GT(roundoffs(static_cast<long double>(1) / 3, Multi(Rational(1, 3))), 1000) << "a long double would be seen";
}

TEST_F(Quads, RoundAllFunctionsCorrectly) {
  using Pair = std::pair<Quad (*)(Quad), Multi (*)(const Multi&)>;
  const Pair functions[] = {{sin, sin},     {cos, cos},   {tan, tan},   {asin, asin}, {acos, acos},
                            {atan, atan},   {sinh, sinh}, {cosh, cosh}, {tanh, tanh}, {asinh, asinh},
                            {atanh, atanh}, {exp, exp},   {log, log},   {sqrt, sqrt}};
  for (std::size_t i = 0; i < std::size(functions); ++i)
    for (const Rational& r : {Rational(1, 7), Rational(3, 4), Rational(99, 100)}) {
      const Quad x = from_rational<Quad>(r);
      EXPECT_LE(roundoffs(functions[i].first(x), functions[i].second(multi(x))), 1)
          << "function " << i << " of " << to_string(r);
    }
  const Quad two(2), x = from_rational<Quad>(Rational(5, 7));
  EXPECT_LE(roundoffs(acosh(two), acosh(Multi(2))), 1);
  EXPECT_LE(roundoffs(pow(two, x), pow(Multi(2), multi(x))), 1);
  EXPECT_LE(roundoffs(atan2(-x, -two), atan2(-multi(x), Multi(-2))), 1);
  EXPECT_GT(roundoffs(std::sin(static_cast<long double>(x)), sin(multi(x))), 100)
      << "a function of long double would be seen";
}

TEST_F(Quads, PassThroughMpfrAndTextUnchanged) {
  Quad x = 1;
  for (int k = 0; k < 200; ++k) {
    x = x * Quad(-1.7) / Quad(1.3L) + from_rational<Quad>(Rational(k, 977));
    mpfr_t v;
    mpfr_init2(v, kQuadBits);
    set_mpfr(v, x);
    EXPECT_TRUE(quad_of(v) == x) << k;
    mpfr_set_str(v, number_text(x).c_str(), 10, MPFR_RNDN);
    EXPECT_TRUE(quad_of(v) == x) << number_text(x);
    mpfr_clear(v);
    EXPECT_TRUE(Ball(x).radius() == Rational(0) && Ball(x).midpoint_multi() == multi(x));
  }
  EXPECT_EQ(number_text(Quad(0.5)), "0.5");
  EXPECT_EQ(number_text(Quad(-3)), "-3");
  EXPECT_EQ(number_text(from_rational<Quad>(Rational(1, 10))), "0.1");
  EXPECT_EQ(quad_text(Quad(1) / Quad(3), 30), "0.33333333333333333333333333333333");
}

TEST_F(Quads, KnowWhatIsNoNumber) {
  const Quad inf = std::numeric_limits<double>::infinity(), nan = sqrt(Quad(-1));
  EXPECT_FALSE(is_finite(inf) || is_finite(nan) || is_finite(log(Quad(0))));
  EXPECT_EQ(number_text(inf) + number_text(-inf) + number_text(nan), "inf-infnan");
  EXPECT_FALSE(nan < Quad(0) || nan >= Quad(0)) << "not a number is not ordered";
  EXPECT_TRUE(is_finite(Quad(1e300) * Quad(1e300))) << "the range is that of long double";
  EXPECT_FALSE(Ball(inf).is_finite() || Ball(nan).is_finite());
}

TEST_F(Quads, RoundAtOneHalfOfTheLastOfTheirBits) {
  const Quad u = unit_roundoff<Quad>();
  EXPECT_TRUE(Quad(1) + u == Quad(1) && Quad(1) + u * Quad(1.5) > Quad(1));
}

}  // namespace
}  // namespace anholon::quad_test
