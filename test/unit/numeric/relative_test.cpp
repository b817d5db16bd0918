#include <gtest/gtest.h>

#include "numeric/balance.h"
#include "numeric/relative.h"

namespace anholon::relative_test {
namespace {

constexpr double kEps = 0x1p-53;

TEST(RelativeMiss, IsOfTheTermsWhereTheyAreNumbers) {
  EXPECT_EQ(relative_miss(0.0, 0.0, [] { return 1.0; }), 0);
  EXPECT_EQ(relative_miss(1e-3, 2.0, [] { return 2.0; }), 5e-4);
  EXPECT_EQ(relative_miss(-1e-12, 2e-9, [] { return 1.0; }), 5e-4) << "small terms are no smaller a mistake";
  EXPECT_EQ(relative_miss(1e-30, 0.0, [] { return 0.0; }), 1) << "nothing that it could be round-off of";
}

TEST(RelativeMiss, RoundoffIsOfWhatTheTermsAreMadeOf) {
  EXPECT_EQ(relative_miss(kEps, kEps, [] { return 1.0; }), kEps);
  EXPECT_EQ(relative_miss(kEps * 300, kEps * 300, [] { return 1.0; }), 1) << "more than round-off of 1";
  EXPECT_EQ(relative_miss(kEps, kEps, [] { return std::numeric_limits<double>::infinity(); }), 1)
      << "nothing is known of it";
  EXPECT_EQ(relative_miss(kEps, 1.0, []() -> double { throw std::logic_error("not asked"); }), kEps);
}

TEST(Balance, RowsAndColumnsOfLikeSizeInAnyUnits) {
  // Masses of 1e-6 and 1e6 on one rod, its tension in newtons.
  Matrix<long double> j(3, 3);
  j.data = {1e-6L, 0, 0.6L, 0, 1e6L, -0.6L, 0.6L, -0.6L, 0};
  const Balance b = balance_of(j);
  for (std::size_t i = 0; i < 3; ++i) {
    double row = 0, column = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      row = std::max(row, std::abs(static_cast<double>(j(i, k))) * b.row[i] * b.column[k]);
      column = std::max(column, std::abs(static_cast<double>(j(k, i))) * b.row[k] * b.column[i]);
    }
    EXPECT_GT(row, 0.3);
    EXPECT_LT(row, 3);
    EXPECT_GT(column, 0.3);
    EXPECT_LT(column, 3);
  }
}

TEST(Balance, AnEmptyRowIsLeftAlone) {
  Matrix<double> a(2, 2);
  a.data = {4, 0, 0, 0};
  const Balance b = balance_of(a);
  EXPECT_EQ(b.row[1], 1);
  EXPECT_NEAR(b.row[0] * b.column[0] * 4, 1, 1e-12);
}

}  // namespace
}  // namespace anholon::relative_test
