// Matrices of expressions, and their inverses by elimination on the graph.
#pragma once
#include <memory>

#include "expr/diff.h"
#include "expr/handles.h"
#include "tape/point.h"

namespace anholon {

using Rows = std::vector<Column>;

// Returns sum_b X_b Y_b,a: the sums over dependent coordinates of [L 3.13] and similar equations.
Column operator*(const Column& X, const Rows& Y);
Rows operator-(const Rows& a, const Rows& b);
Rows operator+(const Rows& a, const Rows& b);
Rows operator*(const Rational& c, const Rows& a);

// An expression with more nodes is not rewritten.
inline constexpr std::size_t kShortEnough = 200;
// Returns e, or its expanded form if that is shorter.
Expr shorter(Expr e, std::size_t longest = kShortEnough);
// Returns a short form of e: common factors of fractions are cancelled, also those hidden by sin^2 + cos^2 = 1.
Expr shortest(Expr e);

// The purpose of a result: `readable` is for a reader and simplified with more work, `brief` is an intermediate result.
enum class Wanted : std::uint8_t { readable, brief };
// Returns A^-1 by elimination on the graph, each entry in the shorter of its forms. Pivots are entries that are not
// small at the point; pivots that can vanish elsewhere are added to `divisors`.
Rows inverse(const Rows& A, PointValues& at, Column& divisors, Wanted wanted);

// Inverts matrices with pivots that are not small near a state, and records the pivots that can vanish elsewhere.
class PivotChoice {
 public:
  PivotChoice() = default;
  // `at`: values near the state.
  explicit PivotChoice(std::shared_ptr<PointValues> at) : at_(std::move(at)) {}

  Rows inverse(const Rows& A, Wanted wanted) { return anholon::inverse(A, *at_, divisors_, wanted); }
  // The pivots recorded so far: the divisors of all inverses.
  const Column& divisors() const { return divisors_; }
  // The values near the state; nullptr if there are none.
  PointValues* point() const { return at_.get(); }

  // Returns a copy with values of its own.
  PivotChoice copy() const;
  // The handles of the divisors (expr/handles.h).
  friend void for_each_expression(PivotChoice& p, const ExprVisitor& f);

 private:
  std::shared_ptr<PointValues> at_;
  Column divisors_;
};

void for_each_expression(PivotChoice& p, const ExprVisitor& f);

}  // namespace anholon
