// LU of a sparse square matrix, column by column, with threshold partial pivoting (Gilbert & Peierls 1988).
//
// An order of elimination names, for each column, the row of its pivot. The pivot is taken there unless it is smaller
// than a tenth of the largest entry that is left of the column, with rows divided by their largest entry; then it is
// that largest entry. The bits depend on the matrix and the order alone.
#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "numeric/number.h"

namespace anholon {

// The entries of a square matrix by columns: those of column j are first[j] to first[j + 1]. Entries at the same place
// are added.
struct SparseColumns {
  std::vector<std::uint32_t> first, row;
  std::uint32_t size() const { return static_cast<std::uint32_t>(first.size() - 1); }
};

// The columns in the order of their elimination, each with the preferred row of its pivot.
struct EliminationOrder {
  std::vector<std::uint32_t> column, row;
  std::size_t entries = 0;  // number of entries of the factors, if every preferred pivot is taken
};

template <Number N>
class ThresholdLu {
 public:
  // Factors a matrix. Returns false if no pivot is left in a column, if an entry is not finite, or if the factors have
  // more than `most` entries; the factors are then unusable. `values`: of the entries, in their order.
  bool factor(const SparseColumns& a, const std::vector<N>& values, const EliminationOrder& order,
              std::size_t most = std::numeric_limits<std::size_t>::max());

  // Returns the number of entries of the factors, with the pivots.
  std::size_t entries() const { return lower_.size() + upper_.size() + pivot_.size(); }

  // Replaces the right side, by rows, by the solution, by columns.
  void solve(std::vector<N>& x) const;
  // Does the same with the transposed matrix: the right side is given by columns, the solution by rows.
  void solve_transposed(std::vector<N>& x) const;

 private:
  static constexpr std::uint32_t kNone = 0xffffffffU;
  static constexpr double kThreshold = 0.1;
  struct Entry {
    std::uint32_t at;  // for L the row, for U the step of elimination
    N value;
  };

  void scale_rows(const SparseColumns& a, const std::vector<N>& values);
  void reach(std::uint32_t from);
  std::uint32_t choose_pivot(std::uint32_t preferred) const;

  std::vector<Entry> lower_, upper_;
  std::vector<std::uint32_t> lower_end_, upper_end_;  // of each step
  std::vector<N> pivot_;
  std::vector<std::uint32_t> row_of_, column_of_;  // of each step

  // These serve the present column.
  std::vector<std::uint32_t> step_of_;  // the step in which a row was the pivot's, else kNone
  std::vector<N> scale_, x_;            // for rows: the reciprocal of the largest entry; the column
  std::vector<std::uint32_t> seen_;     // for a row: the last step that met it, plus 1
  // Rows of the column that have been pivot rows, in reverse order; the other rows.
  std::vector<std::uint32_t> done_, left_;
  std::vector<std::uint32_t> path_, next_;  // for the search: rows, and the entries of L to follow
  std::uint32_t now_ = 0;                   // the present step, plus 1
  mutable std::vector<N> side_;
};

template <Number N>
void ThresholdLu<N>::scale_rows(const SparseColumns& a, const std::vector<N>& values) {
  scale_.assign(a.size(), N(0));
  for (std::size_t k = 0; k < values.size(); ++k)
    if (N v = abs(values[k]); v > scale_[a.row[k]]) scale_[a.row[k]] = v;
  for (N& v : scale_)
    if (v > N(0)) v = N(1) / v;
}

// Adds a row and all that follow from it by columns of L to `done_` or `left_`; a row comes after those it leads to.
template <Number N>
void ThresholdLu<N>::reach(std::uint32_t from) {
  const auto enter = [&](std::uint32_t row) {
    seen_[row] = now_;
    const std::uint32_t step = step_of_[row];
    if (step == kNone) {
      left_.push_back(row);
      return;
    }
    path_.push_back(row);
    next_.push_back(step == 0 ? 0 : lower_end_[step - 1]);
  };
  if (seen_[from] == now_) return;
  enter(from);
  while (!path_.empty()) {
    const std::uint32_t row = path_.back(), end = lower_end_[step_of_[row]];
    std::uint32_t k = next_.back();
    while (k < end && seen_[lower_[k].at] == now_) ++k;
    if (k == end) {
      done_.push_back(row);
      path_.pop_back(), next_.pop_back();
    } else {
      next_.back() = k + 1;
      enter(lower_[k].at);
    }
  }
}

template <Number N>
std::uint32_t ThresholdLu<N>::choose_pivot(std::uint32_t preferred) const {
  N most(0);
  std::uint32_t pivot = kNone;
  for (const std::uint32_t row : left_)
    if (N v = abs(x_[row]) * scale_[row]; v > most) most = v, pivot = row;
  if (pivot == kNone || !is_finite(most)) return kNone;
  if (seen_[preferred] == now_ && step_of_[preferred] == kNone &&
      abs(x_[preferred]) * scale_[preferred] >= most * N(kThreshold))
    return preferred;
  return pivot;
}

template <Number N>
bool ThresholdLu<N>::factor(const SparseColumns& a, const std::vector<N>& values, const EliminationOrder& order,
                            std::size_t most) {
  const std::uint32_t n = a.size();
  lower_.clear(), upper_.clear(), pivot_.clear();
  lower_end_.clear(), upper_end_.clear();
  row_of_.clear(), column_of_ = order.column;
  step_of_.assign(n, kNone), seen_.assign(n, 0), x_.assign(n, N(0));
  scale_rows(a, values);
  for (std::uint32_t step = 0; step < n; ++step) {
    now_ = step + 1;
    done_.clear(), left_.clear();
    const std::uint32_t column = order.column[step];
    for (std::uint32_t k = a.first[column]; k < a.first[column + 1]; ++k) reach(a.row[k]);
    for (std::uint32_t k = a.first[column]; k < a.first[column + 1]; ++k) x_[a.row[k]] += values[k];
    for (std::size_t k = done_.size(); k-- > 0;) {
      const std::uint32_t row = done_[k], of = step_of_[row];
      const N u = x_[row];
      x_[row] = N(0);
      if (u == N(0)) continue;
      upper_.push_back({of, u});
      for (std::uint32_t e = of == 0 ? 0 : lower_end_[of - 1]; e < lower_end_[of]; ++e)
        addmul(x_[lower_[e].at], N(-lower_[e].value), u);
    }
    const std::uint32_t pivot = choose_pivot(order.row[step]);
    if (pivot == kNone) return false;
    const N top = x_[pivot];
    for (const std::uint32_t row : left_) {
      if (row != pivot && x_[row] != N(0)) {
        lower_.push_back({row, x_[row] / top});
        if (!is_finite(lower_.back().value)) return false;
      }
      x_[row] = N(0);
    }
    step_of_[pivot] = step;
    pivot_.push_back(top), row_of_.push_back(pivot);
    lower_end_.push_back(static_cast<std::uint32_t>(lower_.size()));
    upper_end_.push_back(static_cast<std::uint32_t>(upper_.size()));
    if (entries() > most) return false;
  }
  return true;
}

template <Number N>
void ThresholdLu<N>::solve(std::vector<N>& x) const {
  const std::size_t n = pivot_.size();
  side_.resize(n);
  for (std::size_t step = 0; step < n; ++step) {
    const N y = x[row_of_[step]];
    side_[step] = y;
    if (y == N(0)) continue;
    for (std::uint32_t e = step == 0 ? 0 : lower_end_[step - 1]; e < lower_end_[step]; ++e)
      addmul(x[lower_[e].at], N(-lower_[e].value), y);
  }
  for (std::size_t step = n; step-- > 0;) {
    const N y = side_[step] / pivot_[step];
    x[column_of_[step]] = y;
    if (y == N(0)) continue;
    for (std::uint32_t e = step == 0 ? 0 : upper_end_[step - 1]; e < upper_end_[step]; ++e)
      addmul(side_[upper_[e].at], N(-upper_[e].value), y);
  }
}

template <Number N>
void ThresholdLu<N>::solve_transposed(std::vector<N>& x) const {
  const std::size_t n = pivot_.size();
  side_.resize(n);
  for (std::size_t step = 0; step < n; ++step) {
    N y = x[column_of_[step]];
    for (std::uint32_t e = step == 0 ? 0 : upper_end_[step - 1]; e < upper_end_[step]; ++e)
      addmul(y, N(-upper_[e].value), side_[upper_[e].at]);
    side_[step] = y / pivot_[step];
  }
  for (std::size_t step = n; step-- > 0;) {
    N y = side_[step];
    for (std::uint32_t e = step == 0 ? 0 : lower_end_[step - 1]; e < lower_end_[step]; ++e)
      addmul(y, N(-lower_[e].value), x[lower_[e].at]);
    x[row_of_[step]] = y;
  }
}

}  // namespace anholon
