#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "base/diagnostic.h"
#include "ensemble/refine/borders.h"
#include "ensemble/refine/refine.h"

namespace anholon::borders_test {

using Places = std::vector<std::int64_t>;
using Truth = std::function<Sight(double, double)>;  // of a point of the unit square

const Borders::Differ kKinds = [](const Sight& a, const Sight& b) { return a.kind != b.kind; };

struct Refined {
  std::set<std::pair<std::int64_t, std::int64_t>> points;  // in units of the last generation
  std::vector<std::size_t> counts;
};

Refined refine(std::size_t side, int generations, const Truth& truth, const Borders::Differ& differ) {
  Borders borders({side, side});
  Refined r;
  Places at;
  for (std::size_t i = 0; i < side; ++i)
    for (std::size_t k = 0; k < side; ++k)
      at.push_back(static_cast<std::int64_t>(i)), at.push_back(static_cast<std::int64_t>(k));
  for (int g = 0;; ++g) {
    const double units = std::ldexp(static_cast<double>(side - 1), g);
    const std::int64_t last = std::int64_t{1} << (generations - g);
    std::vector<Sight> sights;
    for (std::size_t k = 0; k < at.size(); k += 2) {
      sights.push_back(truth(static_cast<double>(at[k]) / units, static_cast<double>(at[k + 1]) / units));
      EXPECT_TRUE(r.points.insert({at[k] * last, at[k + 1] * last}).second) << "a point that is there already";
    }
    r.counts.push_back(sights.size());
    if (g == generations) return r;
    borders.see(sights);
    at = borders.next(differ);
  }
}

const Truth kDisc = [](double x, double y) { return Sight{std::hypot(x - 0.47, y - 0.52) < 0.31 ? 1U : 0U, 0}; };

// The number of corners, not computed, of cells of the finest grid that the border crosses.
std::size_t missed(const Refined& r, std::int64_t side, const Truth& truth) {
  std::size_t count = 0;
  const auto kind = [&](std::int64_t i, std::int64_t k) {
    return truth(static_cast<double>(i) / static_cast<double>(side), static_cast<double>(k) / static_cast<double>(side))
        .kind;
  };
  for (std::int64_t i = 0; i < side; ++i)
    for (std::int64_t k = 0; k < side; ++k) {
      const auto first = kind(i, k);
      if (first == kind(i + 1, k) && first == kind(i, k + 1) && first == kind(i + 1, k + 1)) continue;
      for (const auto& [a, b] : {std::pair{i, k}, {i + 1, k}, {i, k + 1}, {i + 1, k + 1}})
        count += r.points.count({a, b}) == 0;
    }
  return count;
}

TEST(Borders, FindEachCellOfTheFineGridThatABorderCrosses) {
  const Refined r = refine(9, 4, kDisc, kKinds);
  EXPECT_EQ(missed(r, 128, kDisc), 0U);
  EXPECT_LT(r.points.size(), 129U * 129U / 5) << r.points.size();
  // In a grid twice as fine, about twice as many points lie along the border.
  for (std::size_t g = 2; g < r.counts.size(); ++g) {
    EXPECT_LT(r.counts[g], 3 * r.counts[g - 1]);
    EXPECT_GT(2 * r.counts[g], 3 * r.counts[g - 1]);
  }
}

TEST(Borders, WithoutDifferencesNothingIsAdded) {
  const Borders::Differ blind = [](const Sight&, const Sight&) { return false; };
  const Refined r = refine(9, 3, kDisc, blind);
  EXPECT_EQ(r.points.size(), 81U);
  EXPECT_GT(missed(r, 64, kDisc), 0U);
}

// The points that the next cell puts on the common edge show a bay between two points of the first grid.
TEST(Borders, EnterACellAcrossItsEdge) {
  const auto kind = [](double x, double y) {
    const bool strip = y < 0.2, bay = std::abs(x - 0.25) < 0.1 && y < 0.7;
    return Sight{strip || bay ? 1U : 0U, 0};
  };
  Borders borders({3, 3});  // at 0, 1/2, 1
  std::vector<Sight> first;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) first.push_back(kind(i / 2.0, k / 2.0));
  borders.see(first);
  const Places at = borders.next(kKinds);
  std::vector<Sight> second;
  bool on_edge = false;
  for (std::size_t k = 0; k < at.size(); k += 2) {
    EXPECT_LE(at[k + 1], 2) << "the cells above have the same corners";
    second.push_back(kind(static_cast<double>(at[k]) / 4, static_cast<double>(at[k + 1]) / 4));
    on_edge = on_edge || (at[k] == 1 && at[k + 1] == 2);
  }
  EXPECT_TRUE(on_edge);
  borders.see(second);
  const Places third = borders.next(kKinds);
  bool above = false;
  for (std::size_t k = 0; k < third.size(); k += 2) above = above || third[k + 1] > 4;
  EXPECT_TRUE(above) << "the cell above has a point on its lower edge that differs";
}

TEST(Borders, OneAxisIsBisected) {
  Borders borders({1, 5, 1});
  const auto sights = [](const Places& at, double unit) {
    std::vector<Sight> list;
    for (std::size_t k = 0; k < at.size(); k += 3)
      list.push_back({static_cast<double>(at[k + 1]) * unit > 2.3 ? 1U : 0U, 0});
    return list;
  };
  borders.see(sights({0, 0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0}, 1));
  const Places first = borders.next(kKinds);
  EXPECT_EQ(first, (Places{0, 5, 0}));
  borders.see(sights(first, 0.5));
  EXPECT_EQ(borders.next(kKinds), (Places{0, 9, 0}));
}

TEST(Borders, RefuseAGridThatIsTooFine) {
  Borders borders({3, 3, 3});
  borders.see(std::vector<Sight>(27));
  const auto on = [&] {
    for (int g = 0; g < 30; ++g) {
      borders.next(kKinds);
      borders.see({});
    }
  };
  EXPECT_THROW(on(), Failure);
}

TEST(RefineRule, IsReadAsItIsWritten) {
  EXPECT_EQ(refine_rule("theta:0.1").text(), "theta:0.1");
  EXPECT_EQ(refine_rule("a:b:2").column, "a:b");
  EXPECT_EQ(refine_rule("").text(), "");
  for (const char* wrong : {"theta", "theta:", ":1", "theta:-1", "theta:x", "theta:inf", "theta:nan", "theta:1 m"})
    EXPECT_THROW(refine_rule(wrong), MistakeInWord) << wrong;
}

}  // namespace anholon::borders_test
