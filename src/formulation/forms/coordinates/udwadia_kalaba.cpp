// The Udwadia-Kalaba equations (theory: classics): the reactions as an explicit function of the state. With the
// constraints at the level of accelerations, A q'' = b, and E - G = M q'' + h:
//
//   E = G + A^T (A M^-1 A^T)^-1 (b + A M^-1 h)
//
// n equations without multipliers. The inverses are eliminations on the expression graph, entries are not expanded.
#include "formulation/formulation.h"

namespace anholon::forms {

static Column at_zero(const Column& X, const Column& symbols) {
  return symbols.empty() ? X : put(X, symbols, Column(symbols.size(), symbols[0].graph->zero()));
}

static Expr inner(const Column& a, const Column& b) {
  Expr s = a[0].graph->zero();
  for (std::size_t i = 0; i < a.size(); ++i) s += a[i] * b[i];
  return s;
}

static std::string linear_accelerations(const Mechanics& M) {
  for (std::size_t r = 0; r < M.order.size(); ++r) {
    const std::string& name = M.model->constraints[r].name;
    if (M.order[r] > 2)
      return "the constraint '" + name + "' is of order " + std::to_string(M.order[r]) + ", not on accelerations";
    if (M.order[r] < 2) continue;
    for (Expr e : M.Phi[r])
      if (jet_order(e) > 1) return "the constraint '" + name + "' is not linear in the accelerations";
  }
  const Column G = forces(M);  // E is linear in the accelerations
  for (std::size_t a = 0; a < G.size(); ++a)
    for (Expr e : jet_order(G[a]) > 1 ? gradient(G[a], M.qdd) : Column{})
      if (jet_order(e) > 1)
        return "the equation of " + M.model->coordinates[a].name +
               " is not linear in the accelerations: a force, a mass or an expelled velocity holds them";
  return {};
}

// Returns A q'' - b.
static Column acceleration_level(const Mechanics& M, const Elimination& E) {
  Column level;
  for (std::size_t r : E.constraints)
    level.push_back(total_derivative(put_masses(*M.model, M.phi[r]), 2 - static_cast<unsigned>(M.order[r])));
  return level;
}

static Equations equations(const Mechanics& M, const Elimination& E) {
  Graph& g = M.graph();
  const Column miss = lagrange_operator(M) - forces(M), none(M.q.size(), g.zero());
  Rows inertia;  // M
  for (Expr e : miss) inertia.push_back(gradient(e, M.qdd));
  const Column h = at_zero(miss, M.qdd);
  const Rows inverse_inertia = E.inverted(inertia);
  const Column level = acceleration_level(M, E), minus_b = at_zero(level, M.qdd);
  Rows A, A_inverse_inertia, normal;
  for (Expr e : level) A.push_back(gradient(e, M.qdd));
  for (const Column& row : A) A_inverse_inertia.push_back(row * inverse_inertia);
  for (const Column& left : A_inverse_inertia) {
    normal.emplace_back();
    for (const Column& row : A) normal.back().push_back(inner(left, row));
  }
  Column need;  // b + A M^-1 h
  for (std::size_t r = 0; r < A.size(); ++r) need.push_back(inner(A_inverse_inertia[r], h) - minus_b[r]);
  Column mu;
  for (const Column& row : E.inverted(normal)) mu.push_back(inner(row, need));
  return {lagrange_operator(M), forces(M) + (A.empty() ? none : mu * A)};
}

static Label differentiated(const Label& of, unsigned k) {
  return {derivative_name(of.text, k, Format::text), derivative_name(of.latex, k, Format::latex),
          derivative_name(of.mathml, k, Format::mathml)};
}

static Quantities quantities(const Mechanics& M, const Elimination& E) {
  const Column level = acceleration_level(M, E);
  Labels names;
  Rows A;
  for (std::size_t k = 0; k < level.size(); ++k) {
    const std::size_t r = E.constraints[k];
    const std::string& name = M.model->constraints[r].name;
    names.push_back(
        differentiated(indexed(letter("phi"), name, {name_of(*M.model, name)}), 2 - static_cast<unsigned>(M.order[r])));
    A.push_back(gradient(level[k], M.qdd));
  }
  return listed({of_lagrange(M), named(names, level), partials(names, jet_labels(M, 2), A)});
}

extern const Formulation udwadia_kalaba;
const Formulation udwadia_kalaba{"udwadia-kalaba",      "Udwadia–Kalaba equations", "",        "Udwadia & Kalaba 1992",
                                 Unknowns::coordinates, linear_accelerations,       equations, quantities};

}  // namespace anholon::forms
