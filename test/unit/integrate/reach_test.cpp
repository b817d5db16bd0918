#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "integrate/series/sign_change.h"

namespace anholon::reach_test {
namespace {

// exp(-5 x) by its series.
std::vector<double> decay(int degree) {
  std::vector<double> c = {1};
  for (int k = 1; k <= degree; ++k) c.push_back(c.back() * -5 / k);
  return c;
}

TEST(Reach, TheSeriesIsKnownToTheToleranceUpToThere) {
  const int degree = 14;
  const std::vector<double> c = decay(degree);
  for (const double tolerance : {1e-6, 1e-9, 1e-12}) {
    const auto error = [&](double x) {
      double s = 0;
      for (int k = degree; k >= 0; --k) s = s * x + c[static_cast<std::size_t>(k)];
      return std::abs(s - std::exp(-5 * x));
    };
    const double reach = std::exp(log_reach<double>(c.data(), degree, 1e-300, std::log(tolerance)));
    EXPECT_LT(error(reach), tolerance);
    EXPECT_GT(error(2 * reach), tolerance) << "nor is it much too short";
  }
}

TEST(Reach, APolynomialIsKnownEverywhere) {
  const std::vector<double> c = {1, -2, 3, 0, 0};
  EXPECT_EQ(log_reach<double>(c.data(), 4, 1e-300, std::log(1e-12)), 300);
}

// Round-off does not shorten a step either.
TEST(Reach, RoundOffBoundsNothing) {
  const std::vector<double> c = {0, 0, 0, 0, 1e-40};
  EXPECT_EQ(log_reach<double>(c.data(), 4, 0, std::log(1e-12)), 300);
  EXPECT_GT(log_reach<double>(c.data(), 4, 1e-16, std::log(1e-12)), std::log(100)) << "(1e-28/1e-40)^(1/4)";
}

}  // namespace
}  // namespace anholon::reach_test
