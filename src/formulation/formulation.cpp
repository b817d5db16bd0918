#include "formulation/formulation.h"

#include <algorithm>

namespace anholon {

Column right_side(const Mechanics& M) {
  return M.Q + M.QR + M.Qomega + M.minus_dVO + M.minus_dVomega + M.Gamma + M.N;
}

unsigned highest_order(const Mechanics& M) {
  int m = 1;
  for (int order : M.order) m = std::max(m, order);
  return static_cast<unsigned>(m);
}

Column mangeron_deleanu_operator(const Mechanics& M, unsigned m) {
  const Expr T_m = total_derivative(M.T, m);
  return Rational(1, m) * (gradient(T_m, jets(*M.model, m)) - Rational(m + 1) * gradient(M.T, M.q));
}

const Formulation* find_formulation(const std::string& name) {
  for (const Formulation* f : formulations())
    if (name == f->name) return f;
  return nullptr;
}

}  // namespace anholon
