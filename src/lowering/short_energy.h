// Velocities in which a quadratic form is a sum of squares: M = L D L^T on the graph, simple pivots first (theory:
// quasi-velocities).
#pragma once
#include <functional>

#include "lowering/velocity_algebra.h"
#include "mechanics/elimination.h"
#include "tape/point.h"

namespace anholon {

// T = 1/2 v^T M v = 1/2 sum inertia_i p_i^2, inertia constant, p_i = r_i (v_k + sum_j L_jk v_j), k the i-th pivot.
class ShortEnergy {
 public:
  // `v`: symbols. `named` returns the name by which a varying root is used from then on. Returns false if M is not
  // positive or its elimination does not stay short.
  bool diagonalize(Rows M, const Column& v, PointValues& at, Tidy& tidy, const std::function<Expr(Expr)>& named);

  Rows v_by_p;    // v_k = sum_i v_by_p[k][i] p_i
  Column p_by_v;  // p in terms of v
  Column inertia;
  Column pivots;  // D
  // Returns v in terms of p, one by the other; `named` returns the name of each.
  Column v_in(const Column& p, const std::function<Expr(Expr)>& named) const;

  // Returns the index k of p_i.
  std::size_t pivot(std::size_t i) const { return order_[i]; }

 private:
  std::vector<std::size_t> order_;
  Rows above_;  // L_jk by j, in the order of pivots
};

}  // namespace anholon
