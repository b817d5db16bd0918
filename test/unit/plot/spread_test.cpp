#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "plot/spread.h"

namespace anholon::spread_test {

using plot::spread;
using plot::SpreadCase;

std::vector<SpreadCase> grid(int across, int up) {
  std::vector<SpreadCase> cases;
  for (int x = 0; x < across; ++x)
    for (int y = 0; y < up; ++y) cases.push_back({{0.1 * x, 100.0 * y}});
  return cases;
}

TEST(Spread, TakesAnEvenSubgrid) {
  const std::vector<SpreadCase> cases = grid(8, 6);
  std::set<double> xs, ys;
  const std::vector<std::size_t> chosen = spread(cases, 12);
  ASSERT_EQ(chosen.size(), 12U);
  for (const std::size_t k : chosen) xs.insert(cases[k].at.x), ys.insert(cases[k].at.y);
  EXPECT_EQ(xs.size(), 4U);
  EXPECT_EQ(ys, (std::set<double>{100, 300, 500}));
}

TEST(Spread, TakesEvenPartsOfALine) {
  EXPECT_EQ(spread(grid(9, 1), 3), (std::vector<std::size_t>{1, 4, 7}));
  EXPECT_EQ(spread(grid(1, 9), 3), (std::vector<std::size_t>{1, 4, 7}));
  EXPECT_EQ(spread(grid(9, 1), 1), (std::vector<std::size_t>{4}));
}

TEST(Spread, TakesAsManyAsAreAskedForAndThere) {
  for (const std::size_t most : {0U, 1U, 5U, 7U, 11U, 47U}) EXPECT_EQ(spread(grid(8, 6), most).size(), most);
  for (const std::size_t most : {48U, 1000U}) {
    const std::vector<std::size_t> all = spread(grid(8, 6), most);
    EXPECT_EQ(std::set<std::size_t>(all.begin(), all.end()).size(), 48U);
  }
  EXPECT_TRUE(spread({}, 5).empty());
}

TEST(Spread, TakesDrawnCasesFarFromEachOther) {
  std::vector<SpreadCase> cases;
  for (int k = 0; k < 500; ++k) cases.push_back({{k * 37 % 500 / 500.0, k * 91 % 500 / 500.0}});
  const std::vector<std::size_t> chosen = spread(cases, 16);
  ASSERT_EQ(chosen.size(), 16U);
  double least = 1;
  for (const std::size_t a : chosen)
    for (const std::size_t b : chosen)
      if (a != b) least = std::min(least, std::hypot(cases[a].at.x - cases[b].at.x, cases[a].at.y - cases[b].at.y));
  EXPECT_GT(least, 0.1);
}

TEST(Spread, TakesBothSidesOfABorder) {
  std::vector<SpreadCase> cases = grid(10, 10);
  for (SpreadCase& c : cases) c.outcome = c.at.x > 0.45 ? 1 : 0;
  for (int y = 0; y < 10; ++y)
    for (const double x : {0.44, 0.46}) cases.push_back({{x, 100.0 * y}, 1, x > 0.45 ? 1.0 : 0.0});
  std::size_t pairs[2] = {};
  const std::vector<std::size_t> chosen = spread(cases, 16);
  ASSERT_EQ(chosen.size(), 16U);
  for (const std::size_t k : chosen)
    if (cases[k].generation == 1) ++pairs[static_cast<std::size_t>(cases[k].outcome)];
  EXPECT_GE(pairs[0], 4U);
  EXPECT_GE(pairs[1], 4U);
  // Without generations the cases at the border are not preferred.
  for (SpreadCase& c : cases) c.generation = 0;
  const std::vector<std::size_t> plain = spread(cases, 16);
  EXPECT_LT(std::count_if(plain.begin(), plain.end(), [](std::size_t k) { return k >= 100; }), 8);
}

}  // namespace anholon::spread_test
