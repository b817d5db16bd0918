// The first crossing of a polynomial, compared with a search by brute force in many digits.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "integrate/series/sign_change.h"
#include "numeric/multi.h"

namespace anholon::sign_change_test {
namespace {

template <Number N>
N at(const std::vector<N>& c, const N& x) {
  N s(0);
  for (std::size_t k = c.size(); k-- > 0;) s = s * x + c[k];
  return s;
}

// Coefficients of a*(x - r1)*(x - r2)*…
std::vector<double> with_roots(double a, const std::vector<double>& roots) {
  std::vector<double> c = {a};
  for (double r : roots) {
    c.push_back(0);
    for (std::size_t k = c.size() - 1; k > 0; --k) c[k] = c[k - 1] - r * c[k];
    c[0] *= -r;
  }
  return c;
}

std::optional<double> found(const std::vector<double>& c, double h, double floor = 0) {
  return first_below<double>(c.data(), static_cast<int>(c.size()) - 1, h, floor);
}

// Finds the first sample below -floor on a fine grid, then bisects, in 40 digits.
std::optional<double> brute(const std::vector<double>& c, double h, double floor) {
  const PrecisionScope precision(40);
  const std::vector<Multi> wide(c.begin(), c.end());
  constexpr int kSamples = 4000;
  for (int k = 1; k <= kSamples; ++k) {
    Multi high = Multi(h) * Multi(k) / Multi(kSamples), low = Multi(h) * Multi(k - 1) / Multi(kSamples);
    if (!(at(wide, high) < Multi(-floor))) continue;
    for (int i = 0; i < 80; ++i) {
      const Multi middle = (low + high) / Multi(2);
      (at(wide, middle) < Multi(0) ? high : low) = middle;
    }
    return to_double(high);
  }
  return std::nullopt;
}

TEST(FirstBelow, AgreesWithBruteForce) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> number(-1, 1);
  int some = 0, none = 0;
  for (int i = 0; i < 300; ++i) {
    std::vector<double> c;
    const int degree = 1 + static_cast<int>(random() % 14);
    for (int k = 0; k <= degree; ++k) c.push_back(number(random));
    c[0] = std::abs(c[0]);
    const double h = i % 2 ? 1 : -1;
    constexpr double kFloor = 1e-13;
    const auto fast = found(c, h, kFloor), slow = brute(c, h, kFloor);
    // The samples can miss two roots between them.
    if (fast && (!slow || std::abs(*slow) > std::abs(*fast) + 1e-9)) {
      const PrecisionScope precision(40);
      const std::vector<Multi> wide(c.begin(), c.end());
      bool dips = false;
      for (int k = 1; k <= 100'000 && !dips; ++k)
        dips = at(wide, Multi(Multi(*fast) + Multi(h) * Multi(k) / Multi(100'000'000))) < Multi(-kFloor);
      EXPECT_TRUE(dips) << "no dip behind " << *fast;
      continue;
    }
    ASSERT_EQ(fast.has_value(), slow.has_value()) << i;
    (fast ? some : none) += 1;
    if (fast) {
      EXPECT_NEAR(*fast, *slow, 1e-11) << i;
    }
  }
  EXPECT_GT(some, 50);
  EXPECT_GT(none, 50);
}

TEST(FirstBelow, TheFirstOfManyRoots) {
  EXPECT_NEAR(*found(with_roots(-1, {0.25, 0.5, 0.75}), 1), 0.25, 1e-15);
  EXPECT_NEAR(*found(with_roots(1, {0.5, 0.5000001}), 1), 0.5, 1e-8) << "a dip of 2.5e-15";
  EXPECT_FALSE(found(with_roots(1, {0.5, 0.5}), 1, 1e-15)) << "it touches";
  EXPECT_FALSE(found(with_roots(1, {0.5, 0.5, 0.25, 0.25}), 1, 1e-15)) << "it touches twice";
  EXPECT_NEAR(*found(with_roots(-1, {0.5, 0.5, 0.5}), 1, 1e-18), 0.5, 1e-5) << "a triple root passes";
}

TEST(FirstBelow, AtTheEnds) {
  EXPECT_FALSE(found({0, 1}, 1)) << "leaves zero upwards";
  ASSERT_TRUE(found({0, -1}, 1)) << "leaves zero downwards";
  EXPECT_LT(*found({0, -1}, 1), 1e-15);
  EXPECT_EQ(*found({-1, 1}, 1), 0) << "is below from the start";
  EXPECT_FALSE(found({1, -1}, 1, 1e-15)) << "reaches zero at the end, and is not below it";
  EXPECT_NEAR(*found({1, -1.0000001}, 1), 1, 1e-6);
  EXPECT_FALSE(found({1, -0.9999999}, 1));
  EXPECT_NEAR(*found({1, 1}, -2), -1, 1e-15) << "backwards";
  EXPECT_FALSE(found({0, 0, 0}, 1));
  EXPECT_FALSE(found({1, NAN}, 1));
}

// The mutant: a search that compares only both ends of the interval misses the dip.
TEST(FirstBelow, IsNoLookAtTheEnds) {
  const std::vector<double> c = with_roots(1, {0.4, 0.6});
  EXPECT_GT(at(c, 0.0), 0);
  EXPECT_GT(at(c, 1.0), 0);
  EXPECT_TRUE(found(c, 1));
}

}  // namespace
}  // namespace anholon::sign_change_test
