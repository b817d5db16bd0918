#include "formulation/operators.h"

#include <algorithm>

namespace anholon {

Column right_side(const Mechanics& M) { return forces(M) + M.N; }

unsigned highest_order(const Mechanics& M) {
  int m = 1;
  for (int order : M.order) m = std::max(m, order);
  return static_cast<unsigned>(m);
}

unsigned order_of(const Mechanics& M, const Elimination& E) { return E.asked ? E.asked : highest_order(M); }

Expr T(const Mechanics& M, unsigned k) { return total_derivative(M.T, k); }

// Operands are created one after the other: nodes then have the same order with every compiler.
Column lagrange_operator(const Mechanics& M) {
  const Column by_q = gradient(M.T, M.q);
  return total_derivative(gradient(M.T, M.qd)) - by_q;
}

Column nielsen_operator(const Mechanics& M, unsigned m) {
  const Expr T_before = T(M, m - 1);
  const Column below = gradient(T_before, jets(*M.model, m - 1));
  return Rational(m) * total_derivative(gradient(T_before, jets(*M.model, m))) - below;
}

Column micevic_rusov_operator(const Mechanics& M, unsigned m) {
  const Column by_q = gradient(M.T, M.q);
  const Column below = gradient(T(M, m - 1), jets(*M.model, m - 1));
  return gradient(T(M, m), jets(*M.model, m)) - below - by_q;
}

Column mangeron_deleanu_operator(const Mechanics& M, unsigned m) {
  const Column by_q = Rational(m + 1) * gradient(M.T, M.q);
  return Rational(1, m) * (gradient(T(M, m), jets(*M.model, m)) - by_q);
}

}  // namespace anholon
