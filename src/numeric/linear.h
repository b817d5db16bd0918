// Dense linear algebra over any number type: LU with scaled partial pivoting and one step of
// iterative refinement, rank by full pivoting, least change in a metric.
//
// Sizes are those of mechanical systems (tens, a few hundred), matrices are row-major.
#pragma once
#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <numeric>
#include <utility>
#include <vector>

#include "numeric/number.h"

namespace anholon {

template <Number N>
struct Matrix {
  std::size_t rows = 0, cols = 0;
  std::vector<N> data;

  Matrix() = default;
  Matrix(std::size_t r, std::size_t c) : rows(r), cols(c), data(r * c, N(0)) {}
  N& operator()(std::size_t i, std::size_t j) { return data[i * cols + j]; }
  const N& operator()(std::size_t i, std::size_t j) const { return data[i * cols + j]; }
};

// The scales of a matrix: its rows divided by those of `row`, its columns multiplied by those of `column` (all 1 if empty).
template <Number N>
struct Scales {
  std::vector<N> row, column;
};

// Returns an estimate of the smallest singular value of the scaled matrix R^-1 A C, by `sweeps` steps of inverse
// iteration from `direction`, in the unknowns of A, which is kept for the next call. `lu`: solves with A by solve_once
// and solve_transposed.
template <Number N, class Factors>
N smallest_singular_value_by(const Factors& lu, const Scales<N>& scales, std::vector<N>& direction, int sweeps) {
  const std::size_t n = scales.row.size();
  if (n == 0) return N(1);
  if (direction.size() != n) {
    // The entries are uneven on purpose: no kernel of a mechanical system is orthogonal to them by symmetry.
    direction.assign(n, N(1));
    for (std::size_t i = 0; i < n; ++i) direction[i] += N(static_cast<int>((i * 37 + 11) % 17)) / N(23);
  }
  const auto divide_by_columns = [&](std::vector<N>& v) {
    for (std::size_t j = 0; j < scales.column.size(); ++j) v[j] /= scales.column[j];
  };
  divide_by_columns(direction);
  std::vector<N> y, scaled(n);
  N sigma(0);
  for (int k = 0; k < sweeps; ++k) {
    divide_by_columns(direction);
    lu.solve_transposed(direction, y);  // (R^-1 A C)^T w = v  with  w = R y
    for (std::size_t i = 0; i < n; ++i) scaled[i] = y[i] * scales.row[i] * scales.row[i];
    lu.solve_once(scaled, direction);  // (R^-1 A C) v' = w
    divide_by_columns(direction);
    N norm2(0);
    for (const N& v : direction) addmul(norm2, v, v);
    const N length = sqrt(norm2);
    if (!(length > N(0)) || !is_finite(length)) return N(0);
    for (N& v : direction) v /= length;
    sigma = N(1) / sqrt(length);
  }
  for (std::size_t j = 0; j < scales.column.size(); ++j) direction[j] *= scales.column[j];
  return sigma;
}

// The factorization P A = L U of a square matrix. The pivot in a column is the entry that is largest relative to its
// row.
template <Number N>
class Lu {
 public:
  // Returns false if a pivot vanishes or is NaN; the factors are then unusable.
  bool factor(const Matrix<N>& a) { return regular_ = eliminate(a); }

  // True if these are the factors of `a`.
  bool factors(const Matrix<N>& a) const { return regular_ && a.data == original_.data; }

  std::size_t size() const { return order_.size(); }

  // Computes x := A^-1 b, without refinement.
  void solve_once(const std::vector<N>& b, std::vector<N>& x) const {
    const std::size_t n = size();
    x.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      N s = b[order_[i]];
      const N* row = &lu_(order_[i], 0);
      for (std::size_t j = 0; j < i; ++j) addmul(s, N(-row[j]), x[j]);
      x[i] = s;
    }
    for (std::size_t i = n; i-- > 0;) {
      const N* row = &lu_(order_[i], 0);
      N s = x[i];
      for (std::size_t j = i + 1; j < n; ++j) addmul(s, N(-row[j]), x[j]);
      x[i] = s / row[i];
    }
  }

  // Computes x := A^-1 b with one step of iterative refinement.
  void solve(const std::vector<N>& b, std::vector<N>& x) const {
    solve_once(b, x);
    residual_ = b;
    const std::size_t n = size();
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) addmul(residual_[i], N(-original_(i, j)), x[j]);
    solve_once(residual_, correction_);
    for (std::size_t i = 0; i < n; ++i) x[i] += correction_[i];
  }

  // Computes x := A^-T b.
  void solve_transposed(const std::vector<N>& b, std::vector<N>& x) const {
    const std::size_t n = size();
    std::vector<N> y(n);
    for (std::size_t i = 0; i < n; ++i) {
      N s = b[i];
      for (std::size_t j = 0; j < i; ++j) addmul(s, N(-lu_(order_[j], i)), y[j]);
      y[i] = s / lu_(order_[i], i);
    }
    for (std::size_t i = n; i-- > 0;)
      for (std::size_t j = i + 1; j < n; ++j) addmul(y[i], N(-lu_(order_[j], i)), y[j]);
    x.assign(n, N(0));
    for (std::size_t i = 0; i < n; ++i) x[order_[i]] = y[i];
  }

  // Returns an estimate of the smallest singular value of A with rows divided by their largest entry, or with the given
  // scales, by `sweeps` steps of inverse iteration from `direction`, which is kept for the next call.
  N smallest_singular_value(std::vector<N>& direction, const Scales<N>& scales = {}, int sweeps = 3) const {
    return smallest_singular_value_by(*this, scales.row.empty() ? Scales<N>{row_scale_, {}} : scales, direction,
                                      sweeps);
  }

 private:
  // Columns are eliminated in panels; the columns after a panel are updated for all its pivots at once, tile by tile,
  // which reads memory once instead of once for each pivot. Every entry gets its updates in the order of the pivots, so
  // the bits do not depend on these numbers.
  static constexpr std::size_t kPanel = 32, kTile = 32, kAtOnce = 4;

  bool eliminate(const Matrix<N>& a) {
    original_ = a;
    lu_ = a;
    const std::size_t n = a.rows;
    order_.resize(n);
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    row_scale_.assign(n, N(0));
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        if (N v = abs(a(i, j)); v > row_scale_[i]) row_scale_[i] = v;
    for (std::size_t first = 0; first < n; first += kPanel) {
      const std::size_t end = std::min(first + kPanel, n);
      for (std::size_t k = first; k < end; ++k)
        if (!eliminate_in_panel(k, end)) return false;
      update_beyond_panel(first, end);
    }
    return true;
  }

  // Chooses pivot k and updates the columns before `end`. Returns false if there is no pivot.
  bool eliminate_in_panel(std::size_t k, std::size_t end) {
    const std::size_t n = order_.size();
    std::size_t pivot = n;
    N best(0);
    for (std::size_t i = k; i < n; ++i) {
      const N& scale = row_scale_[order_[i]];
      if (!(scale > N(0))) return false;
      if (N v = abs(lu_(order_[i], k)) / scale; v > best) best = v, pivot = i;
    }
    if (pivot == n || !is_finite(best)) return false;
    std::swap(order_[k], order_[pivot]);
    const N* top = &lu_(order_[k], 0);
    for (std::size_t i = k + 1; i < n; ++i) {
      N* row = &lu_(order_[i], 0);
      if (row[k] == N(0)) continue;
      row[k] /= top[k];
      const N factor = -row[k];
      for (std::size_t j = k + 1; j < end; ++j) addmul(row[j], factor, top[j]);
    }
    return true;
  }

  void update_beyond_panel(std::size_t first, std::size_t end) {
    const std::size_t n = order_.size();
    for (std::size_t tile = end; tile < n; tile += kTile)
      for (std::size_t i = first + 1; i < n; ++i) {
        N* const row = &lu_(order_[i], 0);
        const std::size_t last = std::min(i, end), tile_end = std::min(tile + kTile, n);
        std::size_t j = tile;
        if constexpr (std::same_as<N, double>) j = update_side_by_side(row, first, last, j, tile_end);
        for (; j + kAtOnce <= tile_end; j += kAtOnce) {
          N a = row[j], b = row[j + 1], c = row[j + 2], d = row[j + 3];
          for (std::size_t k = first; k < last; ++k) {
            if (row[k] == N(0)) continue;
            const N factor = -row[k];
            const N* const top = &lu_(order_[k], j);
            addmul(a, factor, top[0]), addmul(b, factor, top[1]), addmul(c, factor, top[2]), addmul(d, factor, top[3]);
          }
          row[j] = a, row[j + 1] = b, row[j + 2] = c, row[j + 3] = d;
        }
        for (; j < tile_end; ++j)
          for (std::size_t k = first; k < last; ++k)
            if (!(row[k] == N(0))) addmul(row[j], N(-row[k]), lu_(order_[k], j));
      }
  }

  // Does the same for doubles, which fit into vectors, for whole vectors; returns the first column that is left.
  std::size_t update_side_by_side(double* row, std::size_t first, std::size_t last, std::size_t j, std::size_t end) {
    constexpr std::size_t kWidth = 4, kVectors = 2;
    using Packed [[gnu::vector_size(kWidth * sizeof(double))]] = double;
    for (; j + kVectors * kWidth <= end; j += kVectors * kWidth) {
      Packed a, b, top_a, top_b;
      std::memcpy(&a, row + j, sizeof a), std::memcpy(&b, row + j + kWidth, sizeof b);
      for (std::size_t k = first; k < last; ++k) {
        if (row[k] == 0) continue;
        const double* const top = &lu_(order_[k], j);
        std::memcpy(&top_a, top, sizeof a), std::memcpy(&top_b, top + kWidth, sizeof b);
        a += -row[k] * top_a, b += -row[k] * top_b;
      }
      std::memcpy(row + j, &a, sizeof a), std::memcpy(row + j + kWidth, &b, sizeof b);
    }
    return j;
  }

  Matrix<N> original_, lu_;
  bool regular_ = false;
  std::vector<std::size_t> order_;
  std::vector<N> row_scale_;
  mutable std::vector<N> residual_, correction_;
};

// Rows of A that are linearly independent, chosen by elimination with full pivoting after scaling
// each row to largest entry 1; a pivot below `threshold` ends the choice.
template <Number N>
struct RowChoice {
  std::vector<std::size_t> independent;  // ascending
  std::vector<std::size_t> dependent;    // ascending
  std::vector<std::size_t> vanishing;    // the dependent rows that are zero
  std::vector<std::size_t> pivot_columns;
  N smallest_pivot{1};
};

template <Number N>
RowChoice<N> choose_rows(Matrix<N> a, const N& threshold) {
  RowChoice<N> choice;
  std::vector<bool> used(a.rows, false), column_used(a.cols, false);
  for (std::size_t i = 0; i < a.rows; ++i) {
    N largest(0);
    for (std::size_t j = 0; j < a.cols; ++j)
      if (N v = abs(a(i, j)); v > largest) largest = v;
    if (largest > N(0))
      for (std::size_t j = 0; j < a.cols; ++j) a(i, j) /= largest;
    else
      choice.vanishing.push_back(i);
  }
  for (std::size_t step = 0; step < a.rows; ++step) {
    std::size_t row = a.rows, column = 0;
    N best = threshold;
    for (std::size_t i = 0; i < a.rows; ++i) {
      if (used[i]) continue;
      for (std::size_t j = 0; j < a.cols; ++j)
        if (!column_used[j])
          if (N v = abs(a(i, j)); v > best) best = v, row = i, column = j;
    }
    if (row == a.rows) break;
    used[row] = column_used[column] = true;
    choice.pivot_columns.push_back(column);
    if (best < choice.smallest_pivot) choice.smallest_pivot = best;
    for (std::size_t i = 0; i < a.rows; ++i) {
      if (used[i]) continue;
      const N factor = -(a(i, column) / a(row, column));
      for (std::size_t j = 0; j < a.cols; ++j) addmul(a(i, j), factor, a(row, j));
    }
  }
  for (std::size_t i = 0; i < a.rows; ++i) (used[i] ? choice.independent : choice.dependent).push_back(i);
  return choice;
}

// The smallest change x (in the norm x^T M x) with A x = b, by the bordered system
//   [ M  -A^T ] [x]   [0]
//   [ A    0  ] [mu] = [b].
// A has independent rows and M is positive definite on the kernel of A; false otherwise.
template <Number N>
class LeastChange {
 public:
  // Returns false if there is no solution for these matrices.
  bool factor(const Matrix<N>& m, const Matrix<N>& a) {
    size_ = m.rows;
    const std::size_t n = m.rows, s = a.rows;
    Matrix<N> k(n + s, n + s);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) k(i, j) = m(i, j);
    for (std::size_t i = 0; i < s; ++i)
      for (std::size_t j = 0; j < n; ++j) k(n + i, j) = a(i, j), k(j, n + i) = -a(i, j);
    return lu_.factor(k);
  }
  // REQUIRES: the matrices were factored.
  void solve(const std::vector<N>& b, std::vector<N>& x) {
    rhs_.assign(size_, N(0));
    rhs_.insert(rhs_.end(), b.begin(), b.end());
    lu_.solve(rhs_, solution_);
    x.assign(solution_.begin(), solution_.begin() + static_cast<std::ptrdiff_t>(size_));
  }

 private:
  Lu<N> lu_;
  std::size_t size_ = 0;
  std::vector<N> rhs_, solution_;
};

template <Number N>
bool least_change(const Matrix<N>& m, const Matrix<N>& a, const std::vector<N>& b, std::vector<N>& x) {
  LeastChange<N> change;
  if (!change.factor(m, a)) return false;
  change.solve(b, x);
  return true;
}

}  // namespace anholon
