#include "formulation/formulation.h"

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
  return gradient(T(M, m), jets(*M.model, m)) - gradient(T(M, m - 1), jets(*M.model, m - 1)) - gradient(M.T, M.q);
}

Column mangeron_deleanu_operator(const Mechanics& M, unsigned m) {
  return Rational(1, m) * (gradient(T(M, m), jets(*M.model, m)) - Rational(m + 1) * gradient(M.T, M.q));
}

std::string no_obstacle(const Mechanics&) { return {}; }

std::string first_order_only(const Mechanics& M) {
  for (std::size_t r = 0; r < M.order.size(); ++r)
    if (M.order[r] > 1)
      return "the constraint '" + M.model->constraints[r].name + "' is of order " + std::to_string(M.order[r]) +
             "; this form is for constraints of order 1 (and 0)";
  return {};
}

std::string obstacle(const Formulation& form, const Mechanics& M) {
  if (form.unknowns != Unknowns::multipliers)
    for (const Constraint& c : M.model->constraints)
      if (c.by)
        return "the constraint '" + c.name + "' is kept by the input '" + M.model->controls[*c.by].name +
               "', not by an ideal reaction; this form eliminates ideal reactions";
  return form.obstacle(M);
}

std::string order_obstacle(const Formulation& form, const Mechanics& M, unsigned m) {
  const auto is_of_order = [](int order) {
    return "is of order " + std::to_string(order) + ": it is lifted to a higher order, never to a lower one";
  };
  if (form.highest_m == 0) return "its equations do not depend on an order";
  if (m > form.highest_m)
    return "its equations are of order " + std::to_string(form.highest_m) + (form.highest_m > 1 ? " at most" : "");
  if (!form.eliminates()) return {};
  for (std::size_t r = 0; r < M.order.size(); ++r)
    if (M.order[r] > static_cast<int>(m))
      return "the constraint '" + M.model->constraints[r].name + "' " + is_of_order(M.order[r]);
  if (form.unknowns == Unknowns::quasi_velocities)
    for (const QuasiVelocity& u : M.model->quasi)
      if (u.order > static_cast<int>(m)) return "the quasi-velocity '" + u.name + "' " + is_of_order(u.order);
  return {};
}

// Mićević was read as Mišević.
constexpr std::pair<const char*, const char*> kAliases[] = {
    {"misevic-rusov", "micevic-rusov"},
    {"misevic-rusov-maggi", "micevic-rusov-maggi"},
    {"misevic-rusov-reduced", "micevic-rusov-reduced"},
    {"misevic-rusov-quasi", "micevic-rusov-quasi"},
    {"misevic-rusov-quasi-reduced", "micevic-rusov-quasi-reduced"}};

const Formulation* find_formulation(const std::string& name) {
  for (const auto& [alias, now] : kAliases)
    if (name == alias) return find_formulation(now);
  for (const Formulation* f : formulations())
    if (name == f->name) return f;
  return nullptr;
}

std::string citation(const Formulation& f) {
  return f.equation[0] ? f.equation + (" of " + std::string(f.source)) : f.source;
}

}  // namespace anholon
