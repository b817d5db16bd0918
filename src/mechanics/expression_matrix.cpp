#include "mechanics/expression_matrix.h"

#include <algorithm>
#include <cmath>

#include "base/assert.h"
#include "expr/normal.h"
#include "print/arrange.h"

namespace anholon {

namespace {

// In large matrices, which are not for readers, only shorter expressions are rewritten.
constexpr std::size_t kShortInLarge = 40, kLarge = 5;
// The limit of the work for simplifying intermediate expressions, in products of terms.
constexpr long kShortWork = 20'000;
// A pivot is at least this fraction of the largest candidate.
constexpr double kPivot = 1e-3;

std::size_t nodes(Expr e) { return reachable({&e, 1}).size(); }

}  // namespace

Expr shortest(Expr e) {
  const std::size_t size = nodes(e);
  if (size <= 3 || size > kShortEnough) return e;
  const Expr short_one = arranged(e, {});
  return nodes(short_one) < size ? short_one : e;
}

Expr shorter(Expr e, std::size_t longest) {
  const std::size_t size = nodes(e);
  if (size <= 3 || size > longest) return e;
  const std::optional<Expr> full = expanded(e, kShortWork);
  return full && nodes(*full) < size ? *full : e;
}

Column operator*(const Column& X, const Rows& Y) {
  ANHOLON_ASSERT(X.size() == Y.size());
  if (Y.empty() || Y[0].empty()) return {};
  Graph& g = *Y[0][0].graph;
  Column out;
  for (std::size_t a = 0; a < Y[0].size(); ++a) {
    std::vector<Expr> terms;
    for (std::size_t b = 0; b < X.size(); ++b)
      if (!is_zero(X[b]) && !is_zero(Y[b][a])) terms.push_back(X[b] * Y[b][a]);
    out.push_back(terms.empty() ? g.zero() : sum(terms));
  }
  return out;
}

Rows operator-(const Rows& a, const Rows& b) {
  Rows r;
  for (std::size_t i = 0; i < a.size(); ++i) r.push_back(a[i] - b[i]);
  return r;
}

Rows operator+(const Rows& a, const Rows& b) {
  Rows r;
  for (std::size_t i = 0; i < a.size(); ++i) r.push_back(a[i] + b[i]);
  return r;
}

Rows operator*(const Rational& c, const Rows& a) {
  Rows r;
  for (const Column& row : a) r.push_back(c * row);
  return r;
}

Rows inverse(const Rows& A, PointValues& at, Column& divisors, Wanted wanted) {
  const std::size_t n = A.size();
  if (n == 0) return {};
  Graph& g = *A[0][0].graph;
  const std::size_t longest = n < kLarge ? kShortEnough : kShortInLarge;
  Rows left = A, right(n, Column(n, g.zero()));
  for (std::size_t i = 0; i < n; ++i) right[i][i] = g.one();
  std::vector<std::size_t> row_of(n);
  std::vector<bool> used(n, false), column_used(n, false);
  for (std::size_t step = 0; step < n; ++step) {
    double largest = 0;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        if (!used[i] && !column_used[j] && !is_zero(left[i][j])) largest = std::max(largest, std::abs(at(left[i][j])));
    std::size_t row = n, column = n, best = SIZE_MAX;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) {
        if (used[i] || column_used[j] || is_zero(left[i][j])) continue;
        if (!(std::abs(at(left[i][j])) >= kPivot * largest)) continue;
        const std::size_t cost = is_number(left[i][j]) ? 0 : nodes(left[i][j]);
        if (cost < best) best = cost, row = i, column = j;
      }
    if (row == n)
      throw Failure({}, "the constraints do not determine the dependent coordinates", "choose others with --eliminate");
    used[row] = column_used[column] = true;
    row_of[column] = row;
    const Expr pivot = left[row][column];
    if (!is_number(pivot)) divisors.push_back(pivot);
    for (std::size_t j = 0; j < n; ++j) {
      if (!is_zero(left[row][j])) left[row][j] = shorter(left[row][j] / pivot, longest);
      if (!is_zero(right[row][j])) right[row][j] = shorter(right[row][j] / pivot, longest);
    }
    for (std::size_t i = 0; i < n; ++i) {
      const Expr factor = left[i][column];
      if (i == row || is_zero(factor)) continue;
      for (std::size_t j = 0; j < n; ++j) {
        if (!is_zero(left[row][j]))
          left[i][j] = j == column ? g.zero() : shorter(left[i][j] - factor * left[row][j], longest);
        if (!is_zero(right[row][j])) right[i][j] = shorter(right[i][j] - factor * right[row][j], longest);
      }
    }
  }
  Rows out;
  for (std::size_t j = 0; j < n; ++j) out.push_back(right[row_of[j]]);
  if (wanted == Wanted::readable && n < kLarge)
    for (Column& row : out)
      for (Expr& e : row) e = shortest(e);
  return out;
}

PivotChoice PivotChoice::copy() const {
  PivotChoice p = *this;
  if (at_) p.at_ = std::make_shared<PointValues>(*at_);
  return p;
}

void for_each_expression(PivotChoice& p, const ExprVisitor& f) {
  auto& [at, divisors] = p;
  static_cast<void>(at);
  for_each_expression(divisors, f);
}

}  // namespace anholon
