#include <gtest/gtest.h>

#include "numeric/random/philox.h"

namespace anholon::philox_test {
namespace {

// The known answers of Random123 for philox4x32-10.
TEST(Philox, KnownAnswers) {
  using Four = std::array<std::uint32_t, 4>;
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Four{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  const std::uint32_t f = 0xffffffff;
  EXPECT_EQ(philox({f, f, f, f}, {f, f}), (Four{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Four{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Philox, LawsHaveTheirMoments) {
  constexpr int kDraws = 100000;
  double u = 0, u2 = 0, n = 0, n2 = 0, n4 = 0, both = 0;
  for (std::uint64_t k = 0; k < kDraws; ++k) {
    const double x = Draw(7, k, 0).uniform(), y = Draw(7, k, 1).normal(), z = Draw(7, k, 2).normal();
    EXPECT_GT(x, 0);
    EXPECT_LT(x, 1);
    u += x, u2 += x * x, n += y, n2 += y * y, n4 += y * y * y * y, both += y * z;
  }
  const double e = 5 / std::sqrt(kDraws);  // five deviations of a mean of numbers of deviation 1
  EXPECT_NEAR(u / kDraws, 0.5, e * 0.29);
  EXPECT_NEAR(u2 / kDraws, 1.0 / 3, e * 0.3);
  EXPECT_NEAR(n / kDraws, 0, e);
  EXPECT_NEAR(n2 / kDraws, 1, e * 1.5);
  EXPECT_NEAR(n4 / kDraws, 3, e * 10);
  EXPECT_NEAR(both / kDraws, 0, e) << "streams are independent";
}

TEST(Philox, DrawsDependOnSeedNumberAndStreamOnly) {
  EXPECT_EQ(Draw(1, 2, 3).normal(), Draw(1, 2, 3).normal());
  EXPECT_NE(Draw(1, 2, 3).normal(), Draw(2, 2, 3).normal());
  EXPECT_NE(Draw(1, 2, 3).normal(), Draw(1, 3, 3).normal());
  EXPECT_NE(Draw(1, 2, 3).normal(), Draw(1, 2, 4).normal());
  EXPECT_NE(Draw(1, 2, 3).uniform(), Draw(1, 2 + (std::uint64_t{1} << 32), 3).uniform()) << "all 64 bits count";
}

}  // namespace
}  // namespace anholon::philox_test
