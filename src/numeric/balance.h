// Factors of rows and columns that scale the entries of a matrix to similar sizes: the largest entry of each row and of
// each column is then about 1 (Ruiz 2001: all rows and columns at once are divided by the square root of their largest
// entry, repeatedly).
//
// The rows of a system are forces, torques, accelerations; its unknowns are metres, angles, newtons. After balancing
// they are comparable, whatever the units.
#pragma once
#include <cmath>

#include "numeric/linear.h"

namespace anholon {

struct Balance {
  std::vector<double> row, column;  // powers of 2, so that nothing is rounded
};

template <Number N>
Balance balance_of(const Matrix<N>& a) {
  constexpr int kSweeps = 8;
  Balance b{std::vector<double>(a.rows, 1.0), std::vector<double>(a.cols, 1.0)};
  std::vector<double> size(a.data.size()), row(a.rows), column(a.cols);
  for (std::size_t k = 0; k < size.size(); ++k) size[k] = std::abs(to_double(a.data[k]));
  const auto factor = [](double largest) {
    return largest > 0 && std::isfinite(largest) ? std::exp2(-std::round(0.5 * std::log2(largest))) : 1.0;
  };
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    std::fill(row.begin(), row.end(), 0.0);
    std::fill(column.begin(), column.end(), 0.0);
    for (std::size_t i = 0; i < a.rows; ++i)
      for (std::size_t j = 0; j < a.cols; ++j) {
        const double v = size[i * a.cols + j] * b.row[i] * b.column[j];
        row[i] = std::max(row[i], v);
        column[j] = std::max(column[j], v);
      }
    for (std::size_t i = 0; i < a.rows; ++i) b.row[i] *= factor(row[i]);
    for (std::size_t j = 0; j < a.cols; ++j) b.column[j] *= factor(column[j]);
  }
  return b;
}

}  // namespace anholon
