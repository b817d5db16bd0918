#include <gtest/gtest.h>

#include "numeric/eigen.h"

namespace anholon::eigen_test {
namespace {

constexpr int kDigits = 40;
const double kExact = 1e-35;  // 40 digits, less what a few operations lose

Matrix<Multi> matrix(std::size_t n, const std::vector<int>& entries) {
  Matrix<Multi> a(n, n);
  for (std::size_t i = 0; i < n * n; ++i) a.data[i] = Multi(entries[i]);
  return a;
}

double distance(const Eigenvalue& e, const Multi& re, const Multi& im) {
  return to_double(modulus({e.value.re - re, e.value.im - im}));
}

TEST(Eigenvalues, DistinctOnesInOrder) {
  const PrecisionScope scope(kDigits);
  // (x - 3)(x + 2)(x^2 + 2x + 5), as a companion matrix.
  std::vector<Eigenvalue> e;
  ASSERT_TRUE(eigenvalues(matrix(4, {0, 0, 0, 30, 1, 0, 0, 17, 0, 1, 0, 3, 0, 0, 1, -1}), e));
  ASSERT_EQ(e.size(), 4U);
  EXPECT_LT(distance(e[0], Multi(3), Multi(0)), kExact);
  EXPECT_LT(distance(e[1], Multi(-1), Multi(2)), kExact);
  EXPECT_LT(distance(e[2], Multi(-1), Multi(-2)), kExact);
  EXPECT_LT(distance(e[3], Multi(-2), Multi(0)), kExact);
  for (const Eigenvalue& x : e) EXPECT_EQ(x.multiplicity, 1);
}

TEST(Eigenvalues, VectorsBelongToThem) {
  const PrecisionScope scope(kDigits);
  const Matrix<Multi> a = matrix(4, {1, 2, -3, 0, 4, -1, 2, 5, 0, 7, 1, -2, 3, 0, -6, 2});
  std::vector<Eigenvalue> list;
  ASSERT_TRUE(eigenvalues(a, list));
  for (const Eigenvalue& e : list) {
    Multi largest(0);
    for (std::size_t i = 0; i < 4; ++i) {
      Multi re = -(e.value.re * e.vector[i].re - e.value.im * e.vector[i].im),
            im = -(e.value.re * e.vector[i].im + e.value.im * e.vector[i].re);
      for (std::size_t j = 0; j < 4; ++j) re += a(i, j) * e.vector[j].re, im += a(i, j) * e.vector[j].im;
      EXPECT_LT(to_double(modulus({re, im})), kExact);
      largest = std::max(largest, modulus(e.vector[i]));
    }
    EXPECT_LT(std::abs(to_double(largest) - 1), 1e-8);
  }
}

// Rounding moves a fourfold eigenvalue by a fourth root; the mean of the cluster stays.
TEST(Eigenvalues, JordanBlockIsOneEigenvalue) {
  const PrecisionScope scope(kDigits);
  std::vector<Eigenvalue> e;
  ASSERT_TRUE(eigenvalues(matrix(5, {2, 1, 0, 0, 0, 0, 2, 1, 0, 0, 0, 0, 2, 1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, -1}), e));
  ASSERT_EQ(e.size(), 5U);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(e[static_cast<std::size_t>(i)].multiplicity, 4);
    EXPECT_LT(distance(e[static_cast<std::size_t>(i)], Multi(2), Multi(0)), 1e-28);
    EXPECT_GT(to_double(e[static_cast<std::size_t>(i)].radius), 1e-14);
    EXPECT_LT(to_double(e[static_cast<std::size_t>(i)].radius), 1e-4);
  }
  EXPECT_EQ(e[4].multiplicity, 1);
}

// The same kind of block in another basis, so that its entries are not small numbers.
TEST(Eigenvalues, HiddenJordanBlock) {
  const PrecisionScope scope(kDigits);
  // S (3 + N) S^-1 with S = [1 2; 3 7].
  std::vector<Eigenvalue> e;
  ASSERT_TRUE(eigenvalues(matrix(2, {0, 1, -9, 6}), e));
  EXPECT_EQ(e[0].multiplicity, 2);
  EXPECT_LT(distance(e[0], Multi(3), Multi(0)), 1e-28);
}

TEST(Eigenvalues, NearIsNotEqual) {
  const PrecisionScope scope(kDigits);
  Matrix<Multi> a = matrix(2, {1, 0, 0, 1});
  a(1, 1) += Multi(1e-12);
  std::vector<Eigenvalue> e;
  ASSERT_TRUE(eigenvalues(a, e));
  EXPECT_EQ(e[0].multiplicity, 1);
  EXPECT_GT(to_double(e[0].value.re - e[1].value.re), 0.9e-12);
}

TEST(Eigenvalues, PureFrequenciesHaveNoRealPart) {
  const PrecisionScope scope(kDigits);
  std::vector<Eigenvalue> e;
  ASSERT_TRUE(
      eigenvalues(matrix(4, {0, 0, 1, 0, 0, 0, 0, 1, -5, 2, 0, 0, 2, -2, 0, 0}), e));  // frequencies 1 and sqrt 6
  for (const Eigenvalue& x : e) EXPECT_TRUE(x.value.re == Multi(0));
  EXPECT_LT(distance(e[0], Multi(0), Multi(1)), kExact);
  EXPECT_LT(distance(e[2], Multi(0), sqrt(Multi(6))), kExact);
}

TEST(Eigenvalues, NothingAndNoNumbers) {
  const PrecisionScope scope(kDigits);
  std::vector<Eigenvalue> e;
  EXPECT_TRUE(eigenvalues(Matrix<Multi>(), e));
  EXPECT_TRUE(e.empty());
  ASSERT_TRUE(eigenvalues(Matrix<Multi>(3, 3), e));
  ASSERT_EQ(e.size(), 3U);
  EXPECT_TRUE(e[2].value.re == Multi(0) && e[2].value.im == Multi(0));
  EXPECT_EQ(e[0].multiplicity, 3);
  Matrix<Multi> bad(1, 1);
  bad(0, 0) = Multi(1) / Multi(0);
  EXPECT_FALSE(eigenvalues(bad, e));
}

}  // namespace
}  // namespace anholon::eigen_test
