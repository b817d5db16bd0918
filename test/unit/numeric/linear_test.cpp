#include <random>

#include <gtest/gtest.h>

#include "numeric/linear.h"
#include "support/gap.h"

namespace anholon::linear_test {
namespace {

using test::largest_gap;

template <class N>
Matrix<N> random_matrix(std::size_t rows, std::size_t cols, unsigned seed) {
  std::mt19937 random(seed);
  Matrix<N> a(rows, cols);
  for (N& v : a.data) v = N(static_cast<double>(random()) / 2147483648.0 - 1);
  return a;
}

template <class N>
Matrix<N> operator*(const Matrix<N>& a, const Matrix<N>& b) {
  Matrix<N> c(a.rows, b.cols);
  for (std::size_t i = 0; i < a.rows; ++i)
    for (std::size_t j = 0; j < b.cols; ++j)
      for (std::size_t k = 0; k < a.cols; ++k) c(i, j) += a(i, k) * b(k, j);
  return c;
}

template <class N>
Matrix<N> transposed(const Matrix<N>& a) {
  Matrix<N> t(a.cols, a.rows);
  for (std::size_t i = 0; i < a.rows; ++i)
    for (std::size_t j = 0; j < a.cols; ++j) t(j, i) = a(i, j);
  return t;
}

template <class N>
std::vector<N> times(const Matrix<N>& a, const std::vector<N>& x) {
  std::vector<N> b(a.rows, N(0));
  for (std::size_t i = 0; i < a.rows; ++i)
    for (std::size_t j = 0; j < a.cols; ++j) b[i] += a(i, j) * x[j];
  return b;
}

template <class N>
class LuOf : public testing::Test {
 protected:
  PrecisionScope precision{40};
  // Backward stability: the residual of a random system of this size is at most a few hundred round-offs.
  static constexpr double kResidualRoundoffs = 500;
};
using Numbers = testing::Types<double, long double, Quad, Multi>;
TYPED_TEST_SUITE(LuOf, Numbers);

TYPED_TEST(LuOf, SolvesRandomSystemsAndTheirTransposes) {
  using N = TypeParam;
  const double tolerance = this->kResidualRoundoffs * to_double(unit_roundoff<N>());
  for (std::size_t n : {1, 2, 7, 30, 33, 70}) {
    const Matrix<N> a = random_matrix<N>(n, n, 17 + static_cast<unsigned>(n));
    const std::vector<N> b = random_matrix<N>(n, 1, 3).data;
    Lu<N> lu;
    ASSERT_TRUE(lu.factor(a));
    std::vector<N> x;
    lu.solve(b, x);
    const double size = 1 + largest_gap(x, std::vector<N>(n, N(0)));
    EXPECT_LE(largest_gap(times(a, x), b), tolerance * size) << n;
    lu.solve_transposed(b, x);
    const double size_t = 1 + largest_gap(x, std::vector<N>(n, N(0)));
    EXPECT_LE(largest_gap(times(transposed(a), x), b), tolerance * size_t) << n;
  }
}

TYPED_TEST(LuOf, RowsOfDifferentUnitsDoNotMatter) {
  using N = TypeParam;
  // The rows have units of 10^(+-12), which leave the solution unchanged.
  const std::size_t n = 8;
  Matrix<N> a = random_matrix<N>(n, n, 5);
  const std::vector<N> x0 = random_matrix<N>(n, 1, 6).data;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) a(i, j) = a(i, j) * N(i % 2 ? 1e12 : 1e-12);
  Lu<N> lu;
  ASSERT_TRUE(lu.factor(a));
  std::vector<N> x;
  lu.solve(times(a, x0), x);
  EXPECT_LE(largest_gap(x, x0), 1e5 * to_double(unit_roundoff<N>())) << "condition about 1e3 without the units";
}

TYPED_TEST(LuOf, RefusesSingularAndNotNumbers) {
  using N = TypeParam;
  Lu<N> lu;
  Matrix<N> a(3, 3);
  EXPECT_FALSE(lu.factor(a));
  a = random_matrix<N>(3, 3, 1);
  for (std::size_t j = 0; j < 3; ++j) a(2, j) = N(0);
  EXPECT_FALSE(lu.factor(a));
  a = random_matrix<N>(3, 3, 1);
  EXPECT_TRUE(lu.factor(a));
  a(1, 1) = N(0) / N(0);
  EXPECT_FALSE(lu.factor(a));
}

TEST(Lu, RefinementGainsOnAnIllConditionedSystem) {
  // Wilkinson's growth matrix: elimination loses digits, and one step of refinement restores them.
  const std::size_t n = 40;
  Matrix<double> a(n, n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) a(i, j) = i == j || j == n - 1 ? 1 : i > j ? -1 : 0;
  const std::vector<double> x0 = random_matrix<double>(n, 1, 2).data, b = times(a, x0);
  Lu<double> lu;
  ASSERT_TRUE(lu.factor(a));
  std::vector<double> once, refined;
  lu.solve_once(b, once);
  lu.solve(b, refined);
  EXPECT_GT(largest_gap(once, x0), 1e-8) << "the mutant without refinement";
  EXPECT_LE(largest_gap(refined, x0), 1e-13);
}

TEST(SmallestSingularValue, IsKnownForTriangularAndSymmetricMatrices) {
  const double tolerance = 1e-3;  // an estimate by inverse iteration has three digits
  Lu<double> lu;
  std::vector<double> direction;
  Matrix<double> a(3, 3);
  a(0, 0) = 1, a(1, 1) = 1, a(2, 2) = 1;
  ASSERT_TRUE(lu.factor(a));
  EXPECT_NEAR(lu.smallest_singular_value(direction), 1, tolerance);
  // Rows [1 0], [1 e]: sigma_min = sqrt((2 + e^2 - sqrt(4 + e^4))/2) = e/sqrt(2) + O(e^3).
  for (double e : {1e-2, 1e-6, 1e-10}) {
    Matrix<double> b(2, 2);
    b(0, 0) = b(1, 0) = 1, b(1, 1) = e;
    ASSERT_TRUE(lu.factor(b));
    direction.clear();
    EXPECT_NEAR(lu.smallest_singular_value(direction) / (e / std::sqrt(2.0)), 1, tolerance) << e;
  }
}

TEST(SmallestSingularValue, DoesNotDependOnTheUnitsOfTheRows) {
  Matrix<double> a = random_matrix<double>(5, 5, 9), scaled = a;
  for (std::size_t j = 0; j < 5; ++j) scaled(2, j) *= 1e9, scaled(4, j) *= 1e-9;
  Lu<double> lu;
  std::vector<double> d1, d2;
  ASSERT_TRUE(lu.factor(a));
  const double sigma = lu.smallest_singular_value(d1, {}, 20);
  ASSERT_TRUE(lu.factor(scaled));
  EXPECT_NEAR(lu.smallest_singular_value(d2, {}, 20) / sigma, 1, 1e-9);
}

TEST(SmallestSingularValue, SeesANearlySingularMatrixWhateverItsKernel) {
  // [1 1-e; 1-e 1] has the singular values e and 2 - e; its kernel is nearly (1, -1), orthogonal to (1, 1).
  for (double e : {0.5, 1e-2, 1e-4, 1e-6, 1e-9}) {
    Matrix<double> a(2, 2);
    a(0, 0) = a(1, 1) = 1, a(0, 1) = a(1, 0) = 1 - e;
    Lu<double> lu;
    ASSERT_TRUE(lu.factor(a));
    std::vector<double> direction;
    const double sigma = lu.smallest_singular_value(direction);
    EXPECT_TRUE(sigma > e / 2 && sigma < 2 * e)
        << "an estimate within a factor of two; sigma_min = " << e << ", estimated " << sigma;
  }
}

TEST(ChooseRows, FindsTheRankOfRandomProducts) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const std::size_t rows = 3 + seed % 5, cols = 4 + seed % 3, rank = 1 + seed % 3;
    const Matrix<double> a = random_matrix<double>(rows, rank, seed) * random_matrix<double>(rank, cols, seed + 100);
    const RowChoice<double> choice = choose_rows(a, 1e-9);
    EXPECT_EQ(choice.independent.size(), rank) << seed;
    EXPECT_EQ(choice.dependent.size(), rows - rank) << seed;
    EXPECT_TRUE(choice.vanishing.empty());
    EXPECT_TRUE(std::is_sorted(choice.independent.begin(), choice.independent.end()));
    // The chosen rows have full rank; any other row leaves the rank unchanged.
    Matrix<double> chosen(rank + 1, cols);
    for (std::size_t extra : choice.dependent) {
      for (std::size_t j = 0; j < cols; ++j) {
        for (std::size_t i = 0; i < rank; ++i) chosen(i, j) = a(choice.independent[i], j);
        chosen(rank, j) = a(extra, j);
      }
      EXPECT_EQ(choose_rows(chosen, 1e-9).independent.size(), rank);
    }
  }
}

TEST(ChooseRows, TellsRowsThatVanish) {
  Matrix<double> a = random_matrix<double>(4, 5, 3);
  for (std::size_t j = 0; j < 5; ++j) a(1, j) = 0, a(3, j) = 1e-30 * a(0, j);
  const RowChoice<double> choice = choose_rows(a, 1e-9);
  EXPECT_EQ(choice.independent.size(), 2U) << "a tiny multiple of another row is dependent";
  EXPECT_EQ(choice.vanishing, std::vector<std::size_t>{1});
}

TEST(LeastChange, IsTheSmallestInTheMetric) {
  const PrecisionScope precision(40);
  const double tolerance = 1e-35;  // 40 digits, condition of the random matrices below 1e4
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const std::size_t n = 5, s = 2;
    const Matrix<Multi> root = random_matrix<Multi>(n, n, seed), m = transposed(root) * root,
                        a = random_matrix<Multi>(s, n, seed + 50);
    const std::vector<Multi> b = random_matrix<Multi>(s, 1, seed + 70).data;
    std::vector<Multi> x;
    ASSERT_TRUE(least_change(m, a, b, x));
    EXPECT_LE(largest_gap(times(a, x), b), tolerance);
    // x = M^-1 A^T (A M^-1 A^T)^-1 b.
    Lu<Multi> of_m, of_g;
    ASSERT_TRUE(of_m.factor(m));
    Matrix<Multi> w(n, s);  // M^-1 A^T
    for (std::size_t i = 0; i < s; ++i) {
      std::vector<Multi> row(n), column;
      for (std::size_t j = 0; j < n; ++j) row[j] = a(i, j);
      of_m.solve(row, column);
      for (std::size_t j = 0; j < n; ++j) w(j, i) = column[j];
    }
    ASSERT_TRUE(of_g.factor(a * w));
    std::vector<Multi> mu;
    of_g.solve(b, mu);
    EXPECT_LE(largest_gap(times(w, mu), x), tolerance);
    // The mutant: the least change in the Euclidean norm is different.
    Matrix<Multi> one(n, n);
    for (std::size_t i = 0; i < n; ++i) one(i, i) = Multi(1);
    std::vector<Multi> euclidean;
    ASSERT_TRUE(least_change(one, a, b, euclidean));
    EXPECT_GT(largest_gap(euclidean, x), 1e-3);
  }
}

}  // namespace
}  // namespace anholon::linear_test
