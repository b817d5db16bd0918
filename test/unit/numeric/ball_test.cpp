#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "numeric/ball.h"
#include "numeric/number.h"

namespace anholon::ball_test {
namespace {

using Function = Ball (*)(const Ball&);
const std::map<std::string, std::pair<Function, double (*)(double)>>& functions() {
  static const std::map<std::string, std::pair<Function, double (*)(double)>> all{
      {"sin", {sin, std::sin}},       {"cos", {cos, std::cos}},       {"tan", {tan, std::tan}},
      {"asin", {asin, std::asin}},    {"acos", {acos, std::acos}},    {"atan", {atan, std::atan}},
      {"sinh", {sinh, std::sinh}},    {"cosh", {cosh, std::cosh}},    {"tanh", {tanh, std::tanh}},
      {"asinh", {asinh, std::asinh}}, {"acosh", {acosh, std::acosh}}, {"atanh", {atanh, std::atanh}},
      {"exp", {exp, std::exp}},       {"log", {log, std::log}},       {"sqrt", {sqrt, std::sqrt}},
      {"abs", {abs, std::fabs}}};
  return all;
}

double middle(const Ball& b) { return b.midpoint_multi().to_double(); }

TEST(Ball, HoldsTheFunctionsOfElementaryDefAndTheRoot) {
  std::size_t rows = 0;
#define ROW(name, ...)                                                                                                 \
  ++rows;                                                                                                              \
  EXPECT_TRUE(functions().contains(#name) || std::string(#name) == "sign") << #name;
#include "expr/elementary.def"
#undef ROW
  EXPECT_EQ(rows, functions().size());  // functions() holds sqrt in place of sign
}

TEST(Ball, AgreesWithTheMathematicalLibrary) {
  for (const auto& [name, pair] : functions())
    for (const Rational& x : {Rational(1, 7), Rational(3, 4), Rational(5, 3), Rational(-2, 5)}) {
      const double expected = pair.second(x.get_d());
      const Ball b = pair.first(Ball(x));
      EXPECT_EQ(b.is_finite(), std::isfinite(expected)) << name << " of " << to_string(x);
      if (!std::isfinite(expected)) continue;
      EXPECT_NEAR(middle(b), expected, 4e-15 * (1 + std::abs(expected))) << name;
    }
}

// The ball of the result holds the value at each number of the argument, and is not much larger.
TEST(Ball, EnclosesTheValuesOfAllItsNumbers) {
  for (const auto& [name, pair] : functions()) {
    const Rational center = name == "acosh" ? Rational(3, 2) : Rational(1, 2), radius(1, 8);
    const Ball whole = pair.first(Ball(center, radius));
    for (int k = -8; k <= 8; ++k) {
      const Ball part = pair.first(Ball(Rational(center + radius * Rational(k, 8))));
      EXPECT_TRUE(whole.overlaps(part)) << name << ' ' << k;
    }
    EXPECT_LT(*whole.radius(), 2) << name;
  }
}

TEST(Ball, RationalsAreEnclosed) {
  const Ball third(Rational(1, 3));
  EXPECT_TRUE(third.contains(Rational(1, 3)));
  EXPECT_FALSE(third.radius() == Rational(0));
  EXPECT_TRUE(Ball(Rational(3, 8)).radius() == Rational(0));
  EXPECT_EQ(*Ball(Rational(3, 8)).midpoint(), Rational(3, 8));
  EXPECT_TRUE((third * Ball(3) - Ball(1)).contains_zero());
  EXPECT_FALSE((third * Ball(3) - Ball(Rational(1000001, 1000000))).contains_zero());
  const Ball wide(Rational(1, 3), Rational(1, 10));
  for (const Rational& r : {Rational(7, 30), Rational(13, 30), Rational(1, 3)}) EXPECT_TRUE(wide.contains(r));
  EXPECT_FALSE(wide.contains(Rational(9, 20)));
}

TEST(Ball, PrecisionIsOfTheScope) {
  Rational coarse, fine;
  {
    const BallScope scope(64);
    coarse = *Ball(Rational(1, 3)).radius();
    const BallScope inner(512);
    fine = *Ball(Rational(1, 3)).radius();
  }
  EXPECT_LT(fine * 1000000, coarse);
  EXPECT_EQ(Ball::working_bits(), 128);
}

TEST(Ball, PowersByRationals) {
  const Ball x(Rational(5, 4));
  EXPECT_TRUE(pow(x, Rational(-3)).contains(Rational(64, 125)));
  EXPECT_TRUE(pow(Ball(-2), Rational(3)).contains(Rational(-8)));
  EXPECT_TRUE(pow(Ball(0), Rational(2)).contains(Rational(0)));
  EXPECT_TRUE(pow(Ball(Rational(9, 4)), Rational(-3, 2)).contains(Rational(8, 27)));
  EXPECT_TRUE(pow(Ball(8), Rational(1, 3)).contains(Rational(2)));
  EXPECT_FALSE(pow(Ball(0), Rational(-1)).is_finite());
  EXPECT_FALSE(pow(Ball(-1), Rational(1, 2)).is_finite());
  EXPECT_FALSE(pow(Ball(Rational(0), Rational(1, 2)), Rational(1, 2)).is_finite()) << "reaches below 0";
}

TEST(Ball, ArcOfTwoArguments) {
  for (int y : {-2, 0, 1})
    for (int x : {-3, 1, 2}) EXPECT_NEAR(middle(atan2(Ball(y), Ball(x))), std::atan2(y, x), 1e-15);
  EXPECT_FALSE(atan2(Ball(0), Ball(0)).is_finite());
  // A ball across the cut gives both ends.
  const Ball cut = atan2(Ball(Rational(0), Rational(1, 100)), Ball(-1));
  EXPECT_TRUE(cut.contains(Rational(3)) && cut.contains(Rational(-3)));
}

TEST(Ball, SignIsExactOrSaysThatItIsNot) {
  EXPECT_TRUE((sign(Ball(Rational(-1, 3))) + Ball(1)).is_zero());
  EXPECT_TRUE(sign(Ball(0)).is_zero());
  const Ball open = sign(Ball(Rational(0), Rational(1)));
  EXPECT_TRUE(open.contains(1) && open.contains(-1) && open.contains(0));
  EXPECT_FALSE(abs(Ball(Rational(1, 4), Rational(1))).contains(Rational(-1, 8)));
}

TEST(Ball, DivisionByABallAroundZeroIsNotFinite) {
  EXPECT_FALSE((Ball(1) / Ball(0)).is_finite());
  EXPECT_FALSE((Ball(1) / Ball(Rational(0), Rational(1))).is_finite());
  EXPECT_FALSE(log(Ball(0)).is_finite());
  EXPECT_FALSE(Ball::unknown().is_finite());
  EXPECT_TRUE(Ball::unknown().contains_zero()) << "an unknown value excludes nothing";
}

TEST(Ball, GrowthWithoutBoundEndsInTheUnknown) {
  Ball x(3);
  for (int i = 0; i < 200; ++i) x *= x;
  EXPECT_FALSE(x.is_finite());
  Ball y(Rational(1, 3));
  for (int i = 0; i < 200; ++i) y *= y;
  EXPECT_TRUE(y.contains_zero());
  EXPECT_FALSE(exp(exp(exp(Ball(1000)))).is_finite() && exp(exp(exp(exp(exp(Ball(1000)))))).midpoint());
}

TEST(Ball, PiAndText) {
  EXPECT_EQ(Ball::pi().midpoint_text(10), "3.141592654");
  EXPECT_TRUE(sin(Ball::pi()).contains_zero());
  EXPECT_FALSE(sin(Ball(Rational(22, 7))).contains_zero());
  EXPECT_EQ(Ball(1).radius_text(), "0");
  EXPECT_EQ(Ball(Rational(0), Rational(1, 4)).radius_text().substr(0, 3), "2.5");
  EXPECT_EQ(*Ball(0.1L).radius(), Rational(0)) << "a long double is itself";
  EXPECT_EQ(*Ball(Multi(0.5)).midpoint(), Rational(1, 2));
}

TEST(Ball, TellsABoundOfItsAbsoluteValueRoundedUpwards) {
  EXPECT_EQ(Ball(0).bound_text(), "0");
  EXPECT_EQ(Ball(-3).bound_text(), "3.00e+00");
  EXPECT_EQ(Ball(Rational(1, 3)).bound_text(), "3.34e-01");
  EXPECT_EQ(Ball(Rational(-1), Rational(1, 2)).bound_text(), "1.51e+00");  // the radius itself was rounded upwards
  EXPECT_EQ(Ball::unknown().bound_text(), "inf");
  EXPECT_EQ(log(Ball(Rational(0), Rational(1))).bound_text(), "inf");
  const Ball s = Ball(Rational(-1), Rational(1, 2)).symmetric();
  EXPECT_TRUE(s.contains(Rational(3, 2)) && s.contains(Rational(-3, 2)) && s.midpoint() == Rational(0));
}

TEST(Ball, HasAMaximumOnlyOfWhatIsKnown) {
  const Ball m = max(Ball(Rational(1), Rational(1, 2)), Ball(Rational(5, 4)));
  EXPECT_TRUE(m.contains(Rational(5, 4)) && m.contains(Rational(3, 2)) && !m.contains(Rational(1)));
  EXPECT_FALSE(max(Ball(1), Ball::unknown()).is_finite() || max(Ball::unknown(), Ball(1)).is_finite());
}

TEST(Ball, HasAHullAndALowerEnd) {
  const Ball h = hull(Ball(Rational(1), Rational(1, 2)), Ball(Rational(-3), Rational(1, 4)));
  EXPECT_TRUE(h.contains(Rational(3, 2)) && h.contains(Rational(-13, 4)) && !h.contains(Rational(2)) &&
              !h.contains(Rational(-4)));
  EXPECT_FALSE(hull(Ball(1), Ball::unknown()).is_finite() || lower_end(Ball::unknown()).is_finite());
  // The lower end of 5 ± 4 is a point beside 1.
  const Ball end = lower_end(Ball(Rational(5), Rational(4)));
  EXPECT_TRUE(end.is_positive() && Ball(Rational(1), Rational(1, 1000)).contains_inside(end));
  EXPECT_EQ(end.radius(), Rational(0));
}

}  // namespace
}  // namespace anholon::ball_test
