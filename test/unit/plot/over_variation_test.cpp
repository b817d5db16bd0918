// Columns of a sweep over the varied number.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "plot/over_variation.h"

namespace anholon::plot::over_variation_test {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::vector<double> column(const RunFile& run, std::size_t k) {
  const std::span<const double> values = run.table.values[k];
  return {values.begin(), values.end()};
}

TEST(OverVariation, OneCaseOfEachValueIsACurve) {
  const RunFile run =
      over_variation({"m", "kg", {3, 1, 2, 4}}, {{"x", "m", {30, 10, 20, kNone}}, {"y", "", {3, kNone, 2, kNone}}});
  EXPECT_EQ(run.table.columns, (std::vector<std::string>{"m", "x", "y"}));
  EXPECT_EQ(run.units, (std::map<std::string, std::string>{{"m", "kg"}, {"x", "m"}}));
  EXPECT_EQ(column(run, 0), (std::vector<double>{1, 2, 3}));  // no case has a number at m = 4
  EXPECT_EQ(column(run, 1), (std::vector<double>{10, 20, 30}));
  EXPECT_TRUE(std::isnan(column(run, 2)[0]));
  EXPECT_EQ(column(run, 2)[2], 3);
}

TEST(OverVariation, SeveralCasesOfAValueAreQuantiles) {
  std::vector<double> m(11, 1), x;
  for (int k = 10; k >= 0; --k) x.push_back(k);
  m.push_back(2), x.push_back(7);
  const RunFile run = over_variation({"m", "", m}, {{"x", "", x}});
  EXPECT_EQ(run.table.columns, (std::vector<std::string>{"m", "x 10 %", "x 50 %", "x 90 %"}));
  EXPECT_EQ(column(run, 1), (std::vector<double>{1, 7}));
  EXPECT_EQ(column(run, 2), (std::vector<double>{5, 7}));
  EXPECT_EQ(column(run, 3), (std::vector<double>{9, 7}));
}

TEST(OverVariation, ACurveIsInterruptedWhereCasesAreMissing) {
  const RunFile run = over_variation({"m", "", {1, 3}, "", {1, 2, 3}}, {{"x", "", {10, 30}}});
  EXPECT_EQ(column(run, 0), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(column(run, 1)[0], 10);
  EXPECT_TRUE(std::isnan(column(run, 1)[1]));
  EXPECT_EQ(column(run, 1)[2], 30);
}

TEST(RunsOfCases, AreTheRowsOfEachCase) {
  const std::vector<NamedRun> runs =
      runs_of_cases({0, 0, 1, 2}, {"t", "s", {0, 1, 0, 0}}, {{"x", "m", {5, 6, kNone, 7}}},
                    [](std::size_t row) { return "row " + std::to_string(row); });
  ASSERT_EQ(runs.size(), 2U);  // case 1 has no number
  EXPECT_EQ(runs[0].name, "row 0");
  EXPECT_EQ(runs[1].name, "row 3");
  EXPECT_EQ(runs[0].run.table.columns, (std::vector<std::string>{"t", "x"}));
  EXPECT_EQ(runs[0].run.units.at("x"), "m");
  EXPECT_EQ(column(runs[0].run, 1), (std::vector<double>{5, 6}));
}

}  // namespace
}  // namespace anholon::plot::over_variation_test
