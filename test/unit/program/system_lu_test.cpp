// A large Jacobian in long double is factored in double: its solutions have the digits of long double factors.
#include <random>

#include <gtest/gtest.h>

#include "program/system_lu.h"

namespace anholon::system_lu_test {
namespace {

using W = long double;

Matrix<W> random_matrix(std::size_t n, unsigned seed) {
  std::mt19937 random(seed);
  Matrix<W> a(n, n);
  for (W& v : a.data) v = static_cast<W>(random()) / 2147483648.0L - 1;
  return a;
}

std::vector<W> random_side(std::size_t n) {
  std::vector<W> b = random_matrix(n, 3).data;
  b.resize(n);
  return b;
}

W largest(const std::vector<W>& x) {
  W most = 0;
  for (const W& v : x) most = std::max(most, abs(v));
  return most;
}

std::vector<W> residual(const Matrix<W>& a, const std::vector<W>& b, const std::vector<W>& x) {
  std::vector<W> r = b;
  for (std::size_t i = 0; i < a.rows; ++i)
    for (std::size_t j = 0; j < a.cols; ++j) r[i] -= a(i, j) * x[j];
  return r;
}

TEST(SystemLu, OfManyUnknownsIsInDouble) {
  EXPECT_TRUE([] {
    SystemLu<W> lu;
    return lu.factor(random_matrix(160, 1)) && lu.in_double();
  }());
  EXPECT_FALSE([] {
    SystemLu<W> lu;
    return !lu.factor(random_matrix(40, 1)) || lu.in_double();
  }());
}

TEST(SystemLu, SolvesToTheDigitsOfLongDouble) {
  const std::size_t n = 160;
  const Matrix<W> a = random_matrix(n, 7);
  const std::vector<W> b = random_side(n);
  SystemLu<W> lu;
  Lu<W> wide;
  ASSERT_TRUE(lu.factor(a) && lu.in_double() && wide.factor(a));
  std::vector<W> x, y;
  lu.solve(b, x), wide.solve(b, y);
  EXPECT_LE(largest(residual(a, b, x)), 4 * largest(residual(a, b, y))) << "no worse than factors in long double";
  lu.solve_once(b, x);
  EXPECT_GT(largest(residual(a, b, x)), 100 * largest(residual(a, b, y))) << "one pass has the digits of double";
  for (int pass = 1; pass < lu.passes(); ++pass) {
    std::vector<W> change;
    lu.solve_once(residual(a, b, x), change);
    for (std::size_t i = 0; i < n; ++i) x[i] += change[i];
  }
  EXPECT_LE(largest(residual(a, b, x)), 4 * largest(residual(a, b, y))) << "all passes have those of long double";
}

// Two rows differ by less than a double resolves.
Matrix<W> nearly_singular(std::size_t n, W difference) {
  Matrix<W> a = random_matrix(n, 5);
  for (std::size_t j = 0; j < n; ++j) a(1, j) = a(0, j) + difference * a(1, j);
  return a;
}

TEST(SystemLu, NearASingularMatrixIsInLongDouble) {
  const std::size_t n = 160;
  for (const W difference : {1e-9L, 1e-14L, 1e-17L}) {
    const Matrix<W> a = nearly_singular(n, difference);
    SystemLu<W> lu;
    Lu<W> wide;
    ASSERT_TRUE(lu.factor(a) && wide.factor(a));
    EXPECT_FALSE(lu.in_double()) << static_cast<double>(difference);
    std::vector<W> direction, other;
    EXPECT_EQ(lu.smallest_singular_value(direction), wide.smallest_singular_value(other));
  }
}

TEST(SystemLu, OfEntriesBeyondTheRangeOfDoubleIsInLongDouble) {
  for (const W unit : {1e-300L, 1e310L}) {
    Matrix<W> a = random_matrix(160, 9);
    for (std::size_t j = 0; j < a.cols; ++j) a(4, j) *= unit;
    SystemLu<W> lu;
    ASSERT_TRUE(lu.factor(a));
    EXPECT_FALSE(lu.in_double()) << static_cast<double>(unit);
  }
}

TEST(SystemLu, KnowsTheMatrixOfItsFactors) {
  for (const std::size_t n : {std::size_t{5}, std::size_t{160}}) {
    Matrix<W> a = random_matrix(n, 2);
    SystemLu<W> lu;
    EXPECT_FALSE(lu.factors(a)) << "nothing has been factored";
    ASSERT_TRUE(lu.factor(a));
    EXPECT_TRUE(lu.factors(a));
    a(n - 1, 0) += std::numeric_limits<W>::epsilon();
    EXPECT_FALSE(lu.factors(a));
    for (std::size_t j = 0; j < n; ++j) a(1, j) = a(0, j);
    if (!lu.factor(a)) {
      EXPECT_FALSE(lu.factors(a)) << "there are no factors of a singular matrix";
    }
  }
}

}  // namespace
}  // namespace anholon::system_lu_test
