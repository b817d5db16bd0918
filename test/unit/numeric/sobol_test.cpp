// Points of the Sobol sequence: known points, and their even distribution in each dimension and with a shift.
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "numeric/random/sobol.h"

namespace anholon::sobol_test {
namespace {

// The first points in natural order: v = 1/2, 1/4, 1/8 of van der Corput, v = 1/2, 3/4, 5/8 of x + 1, and 1/2, 3/4, 1/8
// of x^3 + x + 1.
TEST(Sobol, TheFirstPointsAreKnown) {
  const double second[] = {0, 0.5, 0.75, 0.25, 0.625, 0.125, 0.375, 0.875};
  const double fourth[] = {0, 0.5, 0.75, 0.25, 0.125, 0.625, 0.875, 0.375};
  for (std::uint64_t n = 0; n < 8; ++n) {
    EXPECT_NEAR(sobol(n, 0), std::vector<double>({0, 0.5, 0.25, 0.75, 0.125, 0.625, 0.375, 0.875})[n], 1e-15);
    EXPECT_NEAR(sobol(n, 1), second[n], 1e-15) << n;
    EXPECT_NEAR(sobol(n, 3), fourth[n], 1e-15) << n;
  }
}

// Point 4094 in all dimensions, from SciPy's qmc.Sobol: a wrong direction number changes it.
TEST(Sobol, AllDirectionNumbersAreThoseOfJoeAndKuo) {
  const double known[] = {
      0.499755859375, 0.566650390625, 0.502685546875, 0.312255859375, 0.217041015625, 0.490478515625, 0.818115234375,
      0.656005859375, 0.925537109375, 0.415771484375, 0.239013671875, 0.453857421875, 0.437744140625, 0.059326171875,
      0.849365234375, 0.981689453125, 0.467041015625, 0.686767578125, 0.466064453125, 0.403564453125, 0.410888671875};
  for (std::uint32_t d = 0; d < kSobolDimensions; ++d) EXPECT_NEAR(sobol(4094, d), known[d], 1e-15) << d;
}

// Each interval of length 2^-k holds one of 2^k points, for any shift.
TEST(Sobol, EveryDimensionIsEven) {
  for (const std::uint64_t shift : {std::uint64_t{0}, std::uint64_t{0x9E3779B97F4A7C15}})
    for (std::uint32_t d = 0; d < kSobolDimensions; ++d) {
      std::set<int> met;
      for (std::uint64_t n = 0; n < 1024; ++n) met.insert(static_cast<int>(sobol(n, d, shift) * 1024));
      EXPECT_EQ(met.size(), 1024U) << d;
    }
}

TEST(Sobol, QuantilesAreThoseOfTheErrorFunction) {
  for (const double x : {-37.0, -8.0, -5.1, -2.0, -0.3, 0.0, 0.2, 1.5, 4.0, 6.0}) {
    const double p = 0.5 * std::erfc(-x / std::sqrt(2.0));
    // Above the middle, p is rounded to the digits of 1 - p.
    const double slope = std::exp(-x * x / 2) / std::sqrt(2 * M_PI);
    EXPECT_NEAR(normal_quantile(p), x, 1e-14 * (1 + std::abs(x)) + 4e-16 * p / slope) << x;
  }
}

}  // namespace
}  // namespace anholon::sobol_test
