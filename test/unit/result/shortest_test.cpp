// The digits of write_shortest are those of std::to_chars.
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "result/shortest.h"

namespace anholon::shortest_test {
namespace {

std::string ours(double x) {
  char text[kShortestRoom];
  return {text, write_shortest(text, x)};
}

std::string theirs(double x) {
  char text[kShortestRoom];
  return {text, std::to_chars(text, text + sizeof text, x).ptr};
}

TEST(Shortest, IsToCharsWhereNumbersChangeTheirForm) {
  // Numbers around powers of two, whose lower neighbour is half as far, and around powers of ten, where the notation
  // changes.
  for (int e = -1074; e < 1024; ++e)
    for (const double power : {std::ldexp(1.0, e), std::pow(10.0, e / 3)}) {
      double below = power, above = power;
      for (int k = 0; k < 4; ++k) {
        if (!std::isfinite(above)) continue;
        ASSERT_EQ(ours(below), theirs(below));
        ASSERT_EQ(ours(-above), theirs(-above));
        below = std::nextafter(below, 0), above = std::nextafter(above, INFINITY);
      }
    }
  for (const double x : {0.0, -0.0, 5e-324, 1.7976931348623157e308, 9007199254740991.0, 9007199254740992.0, 1e21, 1e22,
                         1e23, 123456789012345680.0, 0.3, 2.5, 100.0, 1e5, 1e-5})
    EXPECT_EQ(ours(x), theirs(x));
}

// Numbers of all exponents, with few digits, whole numbers, and numbers of rows.
TEST(Shortest, IsToCharsForRandomNumbers) {
  const long rounds = std::getenv("ANHOLON_LONG") ? 20'000'000 : 200'000;
  std::mt19937_64 random(1);
  const auto unit = [&] { return std::ldexp(static_cast<double>(random() >> 11), -53); };
  for (long i = 0; i < rounds; ++i) {
    const double any = std::bit_cast<double>(random());
    for (const double x :
         {std::isfinite(any) ? any : 0, static_cast<double>(random() % 10'000'000) / std::pow(10.0, random() % 12),
          static_cast<double>(random() >> (random() % 40 + 11)),
          std::ldexp(unit(), static_cast<int>(random() % 200) - 100),
          (unit() - 0.5) * std::pow(10.0, static_cast<int>(random() % 30) - 10), static_cast<double>(i) * 0.1})
      ASSERT_EQ(ours(x), theirs(x));
  }
}

}  // namespace
}  // namespace anholon::shortest_test
