#pragma once
#include <algorithm>
#include <cmath>
#include <optional>

#include "contact/law/rows.h"

namespace anholon {

// Square linear equations, solved by Gaussian elimination with complete pivoting. Rows are scaled to 1 and columns to
// about 1, because friction may be large.
class PivotedEquations {
 public:
  explicit PivotedEquations(std::size_t n) : n_(n), m_(n * n, 0), right_(n, 0) {}

  long double* operator[](std::size_t row) { return m_.data() + row * n_; }
  ContactNumbers& right() { return right_; }

  // Returns nullopt if the matrix is singular. The equations are overwritten.
  std::optional<ContactNumbers> solve() {
    std::vector<int> scales(n_, 0);
    if (!scale(scales)) return std::nullopt;
    std::vector<std::size_t> column(n_);
    for (std::size_t j = 0; j < n_; ++j) column[j] = j;
    Pivot pivot = largest_of(0);
    for (std::size_t k = 0; k < n_; ++k) {
      if (!(pivot.size > kSame)) return std::nullopt;
      exchange(k, pivot);
      std::swap(column[k], column[pivot.column]);
      pivot = eliminate(k);
    }
    ContactNumbers x(n_);
    for (std::size_t k = n_; k-- > 0;) {
      const long double* row = (*this)[k];
      long double sum = right_[k];
      for (std::size_t j = k + 1; j < n_; ++j) sum -= row[j] * x[column[j]];
      x[column[k]] = sum / row[k];
    }
    for (std::size_t j = 0; j < n_; ++j) x[j] = std::scalbn(x[j], scales[j]);
    return x;
  }

 private:
  // The first of the largest elements, row by row.
  struct Pivot {
    std::size_t row = 0, column = 0;
    long double size = -1;
    void consider(long double x, std::size_t i, std::size_t j) {
      if (x = std::abs(x); x > size) *this = {i, j, x};
    }
  };

  // Returns false if a column or a row is zero, or a column is not finite.
  bool scale(std::vector<int>& scales) {
    ContactNumbers most(n_, 0);
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = 0; j < n_; ++j) most[j] = std::max(most[j], std::abs((*this)[i][j]));
    for (std::size_t j = 0; j < n_; ++j) {
      if (!(most[j] > 0) || !std::isfinite(most[j])) return false;
      scales[j] = -std::ilogb(most[j]);
      most[j] = std::scalbn(1.0L, scales[j]);
    }
    for (std::size_t i = 0; i < n_; ++i) {
      long double* row = (*this)[i];
      long double size = 0;
      for (std::size_t j = 0; j < n_; ++j) size = std::max(size, std::abs(row[j] *= most[j]));
      if (!(size > 0)) return false;
      for (std::size_t j = 0; j < n_; ++j) row[j] /= size;
      right_[i] /= size;
    }
    return true;
  }

  Pivot largest_of(std::size_t k) {
    Pivot pivot{k, k, -1};
    for (std::size_t i = k; i < n_; ++i)
      for (std::size_t j = k; j < n_; ++j) pivot.consider((*this)[i][j], i, j);
    return pivot;
  }

  void exchange(std::size_t k, const Pivot& pivot) {
    if (pivot.row != k) {
      std::swap_ranges((*this)[k], (*this)[k] + n_, (*this)[pivot.row]);
      std::swap(right_[k], right_[pivot.row]);
    }
    if (pivot.column != k)
      for (std::size_t i = 0; i < n_; ++i) std::swap((*this)[i][k], (*this)[i][pivot.column]);
  }

  // Returns the next pivot.
  Pivot eliminate(std::size_t k) {
    const long double* by = (*this)[k];
    Pivot next{k + 1, k + 1, -1};
    for (std::size_t i = k + 1; i < n_; ++i) {
      long double* row = (*this)[i];
      if (const long double factor = row[k] / by[k]; factor != 0) {
        for (std::size_t j = k + 1; j < n_; ++j) row[j] -= factor * by[j];
        right_[i] -= factor * right_[k];
      }
      for (std::size_t j = k + 1; j < n_; ++j) next.consider(row[j], i, j);
    }
    return next;
  }

  std::size_t n_;
  ContactNumbers m_, right_;
};

}  // namespace anholon
