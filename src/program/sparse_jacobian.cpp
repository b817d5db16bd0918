#include "program/sparse_jacobian.h"

#include <algorithm>
#include <cmath>

namespace anholon {

namespace {
// Numbers beyond this size or its reciprocal would lose digits in double.
constexpr double kLargest = 1e290;
// The largest residual of a solution, in round-offs of the terms of the product: factors with large growth exceed it.
constexpr int kMostRoundoffs = 1 << 20;

bool held_by_double(double x) {
  const double size = std::abs(x);
  return size < kLargest && size > 1 / kLargest;
}
}  // namespace

template <Number N>
bool SparseJacobian<N>::take(const Machine<N>& machine, const Sensitivity<N>& sensitivity) {
  if (!std::floating_point<N> || !linearized_ || linearized_->order().column.empty()) return false;
  taken_.clear();
  for (const Linearized::Term& t : linearized_->terms()) {
    switch (t.source) {
    case Linearized::Source::rational:
      taken_.push_back(machine.rational(t.index));
      break;
    case Linearized::Source::by_a:
      taken_.push_back(sensitivity.partials(t.index).a);
      break;
    case Linearized::Source::by_b:
      taken_.push_back(sensitivity.partials(t.index).b);
      break;
    }
    if (const N& p = taken_.back(); p != N(0) && !held_by_double(to_double(p))) return false;
  }
  if (taken_ == partials_) return !refused_;
  std::swap(taken_, partials_);
  forget();
  Partials<double> narrow;
  for (const N& p : partials_) narrow.push_back(to_double(p));
  largest_ = largest_of_rows(*linearized_, narrow, d_);
  refused_ = std::any_of(largest_[0].begin(), largest_[0].end(), [](double v) { return !held_by_double(v); });
  return !refused_;
}

template <Number N>
bool SparseJacobian<N>::factor() {
  const SparseColumns& a = linearized_->columns();
  values_.clear();
  for (const std::uint32_t t : linearized_->term_of())
    values_.push_back(t == Linearized::kNone ? N(1) : N(-partials_[t]));
  factored_ = false;
  refused_ = true;
  // Far from the numbers for which the order was found, other pivots fill in more and more of the factors.
  constexpr std::size_t kMuchFill = 3;
  const EliminationOrder& usual = linearized_->order();
  if (!lu_.factor(a, values_, usual, kMuchFill * usual.entries)) {
    std::vector<double> narrow;
    for (const N& v : values_) narrow.push_back(to_double(v));
    const EliminationOrder own = linearized_->order_for(narrow);
    if (own.column.empty() || !lu_.factor(a, values_, own)) return false;
  }
  std::vector<N> side, x, image, sizes;
  for (const double v : largest_[0]) side.push_back(N(v));
  solve_once(side, x);
  multiply(x, image), multiply_sizes(x, sizes);
  for (std::size_t i = 0; i < side.size(); ++i)
    if (!(abs(N(side[i] - image[i])) <= unit_roundoff<N>() * N(kMostRoundoffs) * (sizes[i] + side[i]))) return false;
  refused_ = false;
  return factored_ = true;
}

template <Number N>
void SparseJacobian<N>::solve_once(const std::vector<N>& b, std::vector<N>& x) const {
  side_.assign(linearized_->size(), N(0));
  const auto equations = static_cast<std::ptrdiff_t>(linearized_->slots());
  std::copy(b.begin(), b.end(), side_.begin() + equations);
  lu_.solve(side_);
  x.assign(side_.begin() + equations, side_.end());
}

template <Number N>
void SparseJacobian<N>::solve_transposed(const std::vector<N>& b, std::vector<N>& x) const {
  side_.assign(linearized_->size(), N(0));
  const auto unknowns = static_cast<std::ptrdiff_t>(linearized_->slots());
  std::copy(b.begin(), b.end(), side_.begin() + unknowns);
  lu_.solve_transposed(side_);
  x.assign(side_.begin() + unknowns, side_.end());
}

template <Number N>
void SparseJacobian<N>::solve(const std::vector<N>& b, std::vector<N>& x) const {
  solve_once(b, x);
  multiply(x, residual_);
  for (std::size_t i = 0; i < b.size(); ++i) residual_[i] = b[i] - residual_[i];
  solve_once(residual_, correction_);
  for (std::size_t i = 0; i < b.size(); ++i) x[i] += correction_[i];
}

template <Number N>
N SparseJacobian<N>::smallest_singular_value(std::vector<N>& direction, const Scales<N>& scales) const {
  constexpr int kSweeps = 3;
  Scales<N> by_rows;
  if (scales.row.empty())
    for (const double v : largest_[0]) by_rows.row.push_back(N(v));
  return smallest_singular_value_by(*this, scales.row.empty() ? by_rows : scales, direction, kSweeps);
}

template <Number N>
const Balance& SparseJacobian<N>::balance() const {
  if (balance_) return *balance_;
  constexpr int kSweeps = 8;
  const std::size_t n = linearized_->unknowns();
  Balance b{std::vector<double>(n, 1.0), std::vector<double>(n, 1.0)};
  Partials<double> narrow;
  for (const N& p : partials_) narrow.push_back(to_double(p));
  const auto factor = [](double sum) {
    return sum > 0 && std::isfinite(sum) ? std::exp2(-std::round(0.5 * std::log2(sum))) : 1.0;
  };
  std::vector<double> rows, columns;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    anholon::multiply_sizes(*linearized_, narrow, b.column, rows);
    multiply_sizes_transposed(*linearized_, narrow, b.row, columns);
    for (std::size_t i = 0; i < n; ++i)
      rows[i] = factor(rows[i] * b.row[i]), columns[i] = factor(columns[i] * b.column[i]);
    for (std::size_t i = 0; i < n; ++i) b.row[i] *= rows[i], b.column[i] *= columns[i];
  }
  return *(balance_ = std::move(b));
}

template <Number N>
Matrix<N> SparseJacobian<N>::matrix() const {
  const std::size_t n = linearized_->unknowns();
  Matrix<N> j(n, n);
  std::vector<N> x(n, N(0)), y;
  for (std::size_t c = 0; c < n; ++c) {
    x[c] = N(1);
    multiply(x, y);
    x[c] = N(0);
    for (std::size_t i = 0; i < n; ++i) j(i, c) = y[i];
  }
  return j;
}

template class SparseJacobian<double>;
template class SparseJacobian<long double>;
template class SparseJacobian<Quad>;
template class SparseJacobian<Multi>;

}  // namespace anholon
