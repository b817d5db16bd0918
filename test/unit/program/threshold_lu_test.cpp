// Sparse factors with threshold pivoting give the solutions of dense factors. They keep the order of elimination as
// long as its pivots are not small, and leave it otherwise.
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "numeric/linear.h"
#include "program/threshold_lu.h"
#include "support/gap.h"

namespace anholon::threshold_lu_test {
namespace {

using test::largest_gap;

template <class N>
struct Sparse {
  SparseColumns places;
  std::vector<N> values;
  Matrix<N> full;
};

// A band of random entries with the given diagonal.
template <class N>
Sparse<N> band(std::uint32_t n, std::uint32_t width, double diagonal, unsigned seed) {
  std::mt19937 random(seed);
  Sparse<N> a{{{0}, {}}, {}, Matrix<N>(n, n)};
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = j < width ? 0 : j - width; i <= std::min(j + width, n - 1); ++i) {
      const N v(i == j ? diagonal : static_cast<double>(random()) / 2147483648.0 - 1);
      a.places.row.push_back(i), a.values.push_back(v), a.full(i, j) = v;
    }
    a.places.first.push_back(static_cast<std::uint32_t>(a.places.row.size()));
  }
  return a;
}

EliminationOrder natural(std::uint32_t n) {
  EliminationOrder order{std::vector<std::uint32_t>(n), std::vector<std::uint32_t>(n)};
  std::iota(order.column.begin(), order.column.end(), 0U), std::iota(order.row.begin(), order.row.end(), 0U);
  return order;
}

template <class N>
class ThresholdLuOf : public testing::Test {
 protected:
  PrecisionScope precision{40};
};
using Numbers = testing::Types<double, long double, Quad, Multi>;
TYPED_TEST_SUITE(ThresholdLuOf, Numbers);

TYPED_TEST(ThresholdLuOf, SolvesAsDenseFactorsDo) {
  using N = TypeParam;
  constexpr std::uint32_t kSize = 60;
  const double round_offs = 1e6 * to_double(unit_roundoff<N>());
  for (const double diagonal : {4.0, 1e-3, 0.0}) {
    const Sparse<N> a = band<N>(kSize, 2, diagonal, 11);
    ThresholdLu<N> lu;
    Lu<N> dense;
    ASSERT_TRUE(lu.factor(a.places, a.values, natural(kSize)) && dense.factor(a.full)) << diagonal;
    std::vector<N> b(kSize), x, y;
    for (std::uint32_t i = 0; i < kSize; ++i) b[i] = N(static_cast<int>(i % 7) - 3);
    x = b, lu.solve(x), dense.solve(b, y);
    EXPECT_LE(largest_gap(x, y), round_offs) << diagonal;
    x = b, lu.solve_transposed(x), dense.solve_transposed(b, y);
    EXPECT_LE(largest_gap(x, y), round_offs) << diagonal;
  }
}

TEST(ThresholdLu, KeepsTheOrderWhereItsPivotsAreNotSmall) {
  // An arrow matrix: elimination from its point fills in everything, from the other end nothing.
  constexpr std::uint32_t kSize = 40;
  SparseColumns a{{0}, {}};
  std::vector<double> values;
  for (std::uint32_t j = 0; j < kSize; ++j) {
    for (std::uint32_t i = 0; i < kSize; ++i)
      if (i == j || i == 0 || j == 0) a.row.push_back(i), values.push_back(i == j ? kSize : 1.0);
    a.first.push_back(static_cast<std::uint32_t>(a.row.size()));
  }
  EliminationOrder order = natural(kSize);
  ThresholdLu<double> lu;
  ASSERT_TRUE(lu.factor(a, values, order));
  EXPECT_EQ(lu.entries(), kSize * kSize);
  std::reverse(order.column.begin(), order.column.end()), std::reverse(order.row.begin(), order.row.end());
  ASSERT_TRUE(lu.factor(a, values, order));
  EXPECT_EQ(lu.entries(), 3 * kSize - 2);
}

TEST(ThresholdLu, StopsWhereItFillsInTooMuch) {
  constexpr std::size_t kPlaces = 4;
  const SparseColumns a{{0, 2, 4}, {0, 1, 0, 1}};
  const std::vector<double> values{1, 2, 2, 1};
  ThresholdLu<double> lu;
  EXPECT_TRUE(lu.factor(a, values, natural(2), kPlaces));
  EXPECT_FALSE(lu.factor(a, values, natural(2), kPlaces - 1));
}

TEST(ThresholdLu, LeavesTheOrderWhereAPivotIsSmall) {
  // Elimination by the small diagonal loses all digits.
  const SparseColumns a{{0, 2, 4}, {0, 1, 0, 1}};
  const std::vector<double> values{1e-20, 1, 1, 1};
  ThresholdLu<double> lu;
  ASSERT_TRUE(lu.factor(a, values, natural(2)));
  std::vector<double> x{1, 2};
  lu.solve(x);
  EXPECT_DOUBLE_EQ(x[0], 1);
  EXPECT_DOUBLE_EQ(x[1], 1);
}

TEST(ThresholdLu, ComparesPivotsInRowsOfEqualSize) {
  // The entry 1e6 is small in its row.
  const SparseColumns a{{0, 2, 4}, {0, 1, 0, 1}};
  const std::vector<double> values{1e6, 1, 1e26, 1};
  ThresholdLu<double> lu;
  ASSERT_TRUE(lu.factor(a, values, natural(2)));
  std::vector<double> x{1e26, 2};
  lu.solve(x);
  EXPECT_DOUBLE_EQ(x[0], 1);
  EXPECT_DOUBLE_EQ(x[1], 1);
}

TEST(ThresholdLu, AddsEntriesOfOnePlace) {
  const SparseColumns a{{0, 3, 4}, {0, 1, 0, 1}};
  ThresholdLu<double> lu;
  ASSERT_TRUE(lu.factor(a, {1.0, 3.0, 1.0, 5.0}, natural(2)));
  std::vector<double> x{4, 11};
  lu.solve(x);
  EXPECT_DOUBLE_EQ(x[0], 2);
  EXPECT_DOUBLE_EQ(x[1], 1);
}

TEST(ThresholdLu, FindsSingularMatrices) {
  const double infinity = std::numeric_limits<double>::infinity();
  const SparseColumns full{{0, 2, 4}, {0, 1, 0, 1}}, empty_column{{0, 2, 2}, {0, 1}};
  ThresholdLu<double> lu;
  EXPECT_TRUE(lu.factor(full, {1, 2, 2, 3}, natural(2)));
  EXPECT_FALSE(lu.factor(full, {1, 2, 2, 4}, natural(2)));
  EXPECT_FALSE(lu.factor(full, {0, 0, 1, 1}, natural(2)));
  EXPECT_FALSE(lu.factor(empty_column, {1, 2}, natural(2)));
  EXPECT_FALSE(lu.factor(full, {1, infinity, 2, 3}, natural(2)));
  EXPECT_FALSE(lu.factor(full, {std::nan(""), 2, 2, 3}, natural(2)));
}

}  // namespace
}  // namespace anholon::threshold_lu_test
