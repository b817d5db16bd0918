// Small vectors and matrices: solutions of least norm, and the parts of vectors in a kernel.
#pragma once
#include "numeric/linear.h"
#include "numeric/number.h"

namespace anholon::test {

inline std::vector<Multi> times(const Matrix<Multi>& A, const std::vector<Multi>& x) {
  std::vector<Multi> out(A.rows, Multi(0));
  for (std::size_t i = 0; i < A.rows; ++i)
    for (std::size_t j = 0; j < A.cols; ++j) out[i] += A(i, j) * x[j];
  return out;
}

inline Matrix<Multi> transposed(const Matrix<Multi>& A) {
  Matrix<Multi> out(A.cols, A.rows);
  for (std::size_t i = 0; i < A.rows; ++i)
    for (std::size_t j = 0; j < A.cols; ++j) out(j, i) = A(i, j);
  return out;
}

// The x of least norm with A x = b, for independent rows.
inline std::vector<Multi> least_norm(const Matrix<Multi>& A, const std::vector<Multi>& b) {
  Matrix<Multi> normal(A.rows, A.rows);
  for (std::size_t i = 0; i < A.rows; ++i)
    for (std::size_t j = 0; j < A.rows; ++j)
      for (std::size_t k = 0; k < A.cols; ++k) normal(i, j) += A(i, k) * A(j, k);
  Lu<Multi> lu;
  std::vector<Multi> y;
  if (A.rows == 0) return std::vector<Multi>(A.cols, Multi(0));
  if (!lu.factor(normal)) throw std::runtime_error("the rows are dependent");
  lu.solve(b, y);
  return times(transposed(A), y);
}

inline std::vector<Multi> plus(std::vector<Multi> a, const std::vector<Multi>& b, int sign = 1) {
  for (std::size_t i = 0; i < a.size(); ++i) sign > 0 ? a[i] += b[i] : a[i] -= b[i];
  return a;
}

// The part of z in the kernel of A.
inline std::vector<Multi> in_kernel(const Matrix<Multi>& A, const std::vector<Multi>& z) {
  return plus(z, least_norm(A, times(A, z)), -1);
}

inline double largest(const std::vector<Multi>& x) {
  double l = 0;
  for (const Multi& v : x) l = std::max(l, std::abs(to_double(v)));
  return l;
}

inline Multi product(const std::vector<Multi>& a, const std::vector<Multi>& b) {
  Multi sum(0);
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace anholon::test
