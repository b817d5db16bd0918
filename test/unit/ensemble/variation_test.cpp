#include <gtest/gtest.h>

#include "ensemble/variation.h"
#include "support/models.h"

namespace anholon::variation_test {

const char* const kBead = R"toml(
coordinates = ["x"]
[parameters]
m = 1
[[particle]]
name = "bead"
mass = "m"
position = "x*ex"
)toml";

// Points of a grid are computed on request: this grid would not fit into memory.
TEST(Variation, AGridHasABillionPoints) {
  const auto model = test::model_of(kBead);
  Variation v;
  v.add("x=1:7:1000000000", *model);
  v.add("m=1/3,2", *model);
  v.must_be_a_grid();
  v.finish(std::nullopt, "n");
  EXPECT_EQ(v.cases(), 2'000'000'000U);
  const auto at = [&](std::size_t k) { return v(k); };
  EXPECT_EQ(at(0), (std::vector<Rational>{1, Rational(1, 3)}));
  EXPECT_EQ(at(1), (std::vector<Rational>{1, 2}));
  EXPECT_EQ(at(2)[0], 1 + Rational(2, 333'333'333));
  EXPECT_EQ(at(v.cases() - 1), (std::vector<Rational>{7, 2}));
  // 2^30 places between two points: the finest grid to which borders are refined.
  const std::int64_t fine = std::int64_t{1} << 30;
  EXPECT_EQ(v.between(std::vector<std::int64_t>{999'999'999 * fine, fine}, 30), at(v.cases() - 1));
  EXPECT_EQ(v.between(std::vector<std::int64_t>{fine + 1, 0}, 30)[0],
            1 + Rational(2, 333'333'333) * (1 + Rational(1, fine)));
}

TEST(Variation, AGridOfEqualPointsIsNoGridToRefine) {
  const auto model = test::model_of(kBead);
  for (const char* word : {"x=2:2:3", "x=2,2,2", "x=1,3,2"}) {
    Variation v;
    v.add(word, *model);
    EXPECT_THROW(v.must_be_a_grid(), Failure) << word;
  }
}

}  // namespace anholon::variation_test
