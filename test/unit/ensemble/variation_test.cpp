#include <gtest/gtest.h>

#include "ensemble/variation.h"
#include "numeric/number.h"
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

const char* const kUnits = R"toml(
coordinates = ["x"]
[parameters]
a = {value = 30, unit = "deg"}
m = {value = 500, unit = "g"}
[[particle]]
name = "bead"
mass = "m"
position = "x*ex + sin(a)*(1 m)*ey"
)toml";

// The values of all cases of one variation.
std::vector<Rational> all_values(const std::string& word, const Model& model, std::optional<std::size_t> cases = {}) {
  Variation v;
  v.add(word, model);
  v.finish(cases, "n");
  std::vector<Rational> list;
  for (std::size_t k = 0; k < v.cases(); ++k) list.push_back(v(k)[0]);
  return list;
}

// The numbers of a parameter are in the unit of the file, exactly as they are given, also beside pi.
TEST(Variation, NumbersAreInTheUnitOfTheFile) {
  const auto model = test::model_of(kUnits);
  EXPECT_EQ(all_values("m=250,0.1,0.25 kg,1/3", *model),
            (std::vector<Rational>{250, Rational(1, 10), 250, Rational(1, 3)}));
  EXPECT_EQ(all_values("a=30,30 deg,pi/6 rad,0.5 rev", *model), (std::vector<Rational>{30, 30, 30, 180}));
  EXPECT_EQ(all_values("a=0:90:4", *model), (std::vector<Rational>{0, 30, 60, 90}));
  Variation listed;
  listed.add("a", {read_constant("30"), read_constant("1 rad")}, *model);
  listed.add(std::make_shared<const CaseTable>("m\n250\n1 kg\n", "table"), *model);
  listed.finish({}, "n");
  EXPECT_EQ(listed(0), (std::vector<Rational>{30, 250}));
  EXPECT_EQ(listed(1), (std::vector<Rational>{30, 1000}));
  EXPECT_EQ(from_rational<double>(listed(2)[0]), 57.29577951308232);
  EXPECT_EQ(listed.varied()[1].unit.in_si(250), Rational(1, 4));
}

// The law of random values is in the unit of the file, so a number that is drawn is the one that is kept.
TEST(Variation, DrawsAreInTheUnitOfTheFile) {
  const auto model = test::model_of(kUnits), without = test::model_of(kBead);
  EXPECT_EQ(all_values("m~normal(500,3)", *model, 20), all_values("m~normal(500,3)", *without, 20));
  EXPECT_EQ(all_values("m~uniform(0.4 kg,500)", *model, 20), all_values("m~uniform(400,500)", *without, 20));
}

}  // namespace anholon::variation_test
