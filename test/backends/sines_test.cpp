// Sines and cosines of the kernels agree with long double in every tier and have the same bits in all lanes.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "kernel/arithmetic.h"

namespace anholon::sines_test {
namespace {

bool fused(const Tier& tier) { return std::string(tier.name) != "plain"; }

// Angles near multiples of a quarter turn, small and large, of both signs.
std::vector<double> angles() {
  std::vector<double> list{0.0, -0.0, 1e-300, 1e-20, 1e-8, 0.5, 0x1p27, -0x1p27, 0x1.fffffffffffffp26, 1e10, 1e22};
  constexpr long double kHalfPi = 1.57079632679489661923132169163975144L;
  for (long k = 1; k < 90'000'000; k = k * 5 / 4 + 1)
    for (const double off : {0.0, 1e-16, 1e-9, 0.3, 0.785, 0.7854, 1.2})
      list.push_back(static_cast<double>(k * kHalfPi + off));
  for (int i = 0; i < 20'000; ++i) list.push_back(std::ldexp(std::fmod(0.618033988749895 * i, 1.0) - 0.5, i % 27));
  const std::size_t n = list.size();
  for (std::size_t i = 0; i < n; ++i) list.push_back(-list[i]);
  while (list.size() % 8 != 0) list.push_back(1);
  return list;
}

// The error of `have` in units of the last place of `want`, or of 1e-8 if `want` is smaller: near multiples of a
// quarter turn, pi/2 in two doubles suffices for an absolute error of 1e-24, but not for all places.
double units(double have, long double want) {
  const double size = std::max(std::abs(static_cast<double>(want)), 1e-8),
               ulp = std::nextafter(size, 2 * size + 1) - size;
  return static_cast<double>(std::abs(have - want)) / ulp;
}

TEST(Sines, AreRightToTheLastPlace) {
  for (const Tier& tier : tiers()) {
    double worst = 0, at = 0;
    for (const double x : angles()) {
      double s, c;
      tier.sines_of_one(&x, nullptr, &s, &c);
      for (const double off : {units(s, sinl(x)), units(c, cosl(x))})
        if (off > worst) worst = off, at = x;
    }
    EXPECT_LT(worst, 0.7) << tier.name << " at " << at;
    const double zero = 0;
    double s, c;
    tier.sines_of_one(&zero, nullptr, &s, &c);
    EXPECT_TRUE(s == 0 && c == 1);
    for (const double none : {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
                              std::numeric_limits<double>::quiet_NaN()}) {
      tier.sines_of_one(&none, nullptr, &s, &c);
      EXPECT_TRUE(s != s && c != c) << tier.name << ' ' << none;
    }
  }
}

// If the angle is known to more digits than a double has, the sine is that of all these digits.
TEST(Sines, KnowWhatAnAngleIsBeyondItsDouble) {
  for (const Tier& tier : tiers())
    for (const double x : angles()) {
      if (!(std::abs(x) < 1e9) || x == 0) continue;
      const double beyond = x * 0x1.3p-55;
      double s, c;
      tier.sines_of_one(&x, &beyond, &s, &c);
      EXPECT_LT(units(s, sinl(x) + beyond * cosl(x) - beyond * beyond / 2 * sinl(x)), fused(tier) ? 0.8 : 1.2)
          << tier.name << ' ' << x;
      EXPECT_LT(units(c, cosl(x) - beyond * sinl(x) - beyond * beyond / 2 * cosl(x)), fused(tier) ? 0.8 : 1.2)
          << tier.name << ' ' << x;
    }
}

TEST(Sines, HaveTheSameBitsInAllLanesAndTiers) {
  const std::vector<double> list = angles();
  const Tier* first = nullptr;
  for (const Tier& tier : tiers()) {
    if (!fused(tier)) continue;
    if (!first) first = &tier;
    const std::size_t lanes = static_cast<std::size_t>(tier.lanes);
    for (std::size_t i = 0; i < list.size(); i += lanes) {
      alignas(64) double x[8], beyond[8], s[8], c[8];
      for (std::size_t k = 0; k < lanes; ++k) x[k] = list[i + k], beyond[k] = x[k] * 0x1.7p-54;
      tier.sines_of_all(x, beyond, s, c);
      for (std::size_t k = 0; k < lanes; ++k) {
        double one_s, one_c;
        first->sines_of_one(&x[k], &beyond[k], &one_s, &one_c);
        EXPECT_TRUE(s[k] == one_s && c[k] == one_c) << tier.name << ' ' << x[k];
      }
    }
  }
}

}  // namespace
}  // namespace anholon::sines_test
