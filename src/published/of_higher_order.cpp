// Equations about motions whose constraints are nonlinear in derivatives of an order m of three or more.
//
// Routh's equations A q'' = G + lambda^T dphi/dq^(m) then contain q^(m), and with phi = 0 they determine q^(m) and
// lambda by the lower derivatives. The accelerations are substituted as functions of q^(m) and lambda, and then phi =
// 0.
#include <algorithm>

#include "mechanics/expression_matrix.h"
#include "proof/few_functions.h"
#include "proof/witness.h"
#include "published/compare.h"

namespace anholon {

// Returns true if the verdict is decided.
bool Comparer::of_higher_order(Expr P, Comparison& out) {
  const Model& model = *M_.model;
  if (M_.order.empty()) return false;
  const int m = M_.order[0];
  if (m < 3 || std::any_of(M_.order.begin(), M_.order.end(), [&](int order) { return order != m; })) return false;
  int highest = std::max(m, jet_order(P));
  for (const NodeId id : symbols({&P, 1}))
    if (const Node& n = M_.graph().node(id); n.kind == Kind::multiplier) highest = std::max(highest, m + n.order);
  Column routh = put_masses(model, lagrange_operator(M_) - forces(M_) - M_.N), phi = put_masses(model, M_.phi);
  for (Expr& e : routh) e = put_rates(model, e);
  for (Expr& e : phi) e = put_rates(model, e);
  const Column accelerations = jets(model, 2);
  Column equations = routh, unknowns;
  equations.insert(equations.end(), phi.begin(), phi.end());
  Rows A;
  for (Expr r : routh) A.push_back(gradient(r, accelerations));
  if (highest == m) try {
      PointValues at = generic_values(0);
      Column divisors;
      const Rows inverted = inverse(A, at, divisors, Wanted::brief);
      const Column none(accelerations.size(), M_.graph().zero());
      Column values;
      for (const auto& row : inverted) {
        Expr value = M_.graph().zero();
        for (std::size_t b = 0; b < row.size(); ++b) value = value - row[b] * put(routh[b], accelerations, none);
        values.push_back(value);
      }
      const Expr on = put(P, accelerations, values);
      bool constraints = false, zero = shown_zero_in_few_functions(on, Effort::full);
      SolvedEquations solved;
      Column open = jets(model, static_cast<unsigned>(m));
      if (!zero && std::all_of(phi.begin(), phi.end(), [&](Expr f) { return solved.add(f, open); })) {
        const Column branches = solved.branches(on);
        constraints = true;
        zero = !branches.empty() && std::all_of(branches.begin(), branches.end(),
                                                [](Expr e) { return shown_zero_in_few_functions(e, Effort::full); });
      }
      if (zero) {
        out.verdict = Verdict::proved;
        out.what = "a combination of the equations of motion";
        if (constraints) out.what += ", with the constraints put in";
        return true;
      }
    } catch (const Failure&) {
      // A pivot vanishes: only a point can decide.
    }
  // The same equations, differentiated, determine the higher derivatives.
  Column level = equations;
  for (int k = m; k <= highest; ++k) {
    const Column q = jets(model, static_cast<unsigned>(k));
    unknowns.insert(unknowns.end(), q.begin(), q.end());
    for (std::size_t r = 0; r < phi.size(); ++r)
      unknowns.push_back(M_.graph().multiplier(static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(k - m)));
    if (k > m) {
      level = total_derivative(level);
      for (Expr& e : level) e = put_rates(model, e);
      equations.insert(equations.end(), level.begin(), level.end());
    }
  }
  WitnessSearch search = find_witness(Difference{{}, P, {}, {}, {}, {}}, equations, unknowns, model);
  out.detail = search.witness ? search.detail : search.detail + " of the motion; no proof was found";
  out.witness = std::move(search.witness);
  if (out.witness) out.verdict = Verdict::refuted;
  return out.witness.has_value();
}

}  // namespace anholon
