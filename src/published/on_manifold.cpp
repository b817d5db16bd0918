// Equations without multipliers on the manifold of the constraints, if these are solved: the dependent derivatives are
// substituted, and the remainder is compared with the contractions B^T (E - G) = 0. This serves constraints of order 2
// and more that are nonlinear in their highest derivatives, for which Routh's equations are not linear in the
// accelerations and multipliers.
#include <algorithm>
#include <cmath>

#include "numeric/linear.h"
#include "proof/witness.h"
#include "published/at_points.h"
#include "published/compare.h"

namespace anholon {

namespace {

constexpr int kPoints = 3;

}  // namespace

// Returns the contractions on the manifold, one for each independent coordinate, masses substituted.
const Column& Comparer::contractions() {
  if (!contractions_) {
    const Column a = put_masses(*M_.model, lagrange_operator(M_) - forces(M_));
    contractions_ = elimination_.on(elimination_.contract(a));
    for (Expr& e : *contractions_) e = put_rates(*M_.model, e);
  }
  return *contractions_;
}

// Writes P as a combination of the contractions if the constraints are not solved: the coefficient of each comes from a
// symbol that the other contractions do not contain.
bool Comparer::by_contractions(Expr P, Comparison& out) {
  const Elimination& E = elimination_;
  const Graph& g = M_.graph();
  if (E.solved || E.quasi || E.dependent.empty()) return false;
  const std::vector<NodeId> held = symbols({&P, 1});
  if (std::any_of(held.begin(), held.end(), [&](NodeId id) { return g.node(id).kind == Kind::multiplier; }))
    return false;
  const Column& a = contractions();
  PointValues at = generic_values(0);
  Expr rest = P;
  std::string what;
  for (std::size_t nu = 0; nu < a.size(); ++nu)
    for (const NodeId id : held) {
      const Expr by{P.graph, id};
      const auto slope = [&](Expr e) { return at(partial(e, by)); };
      bool alone = is_not_zero(partial(a[nu], by), at);
      for (std::size_t k = 0; k < a.size(); ++k) alone = alone && (k == nu || slope(a[k]) == 0);
      for (Expr phi : E.phi) alone = alone && slope(phi) == 0;
      if (!alone) continue;
      const Expr factor = tidy(partial(P, by) / partial(a[nu], by));
      if (is_zero(factor)) break;
      rest = rest - factor * a[nu];
      what += (what.empty() ? "" : " and ") + std::string("the equation of ") +
              M_.model->coordinates[E.independent[nu]].name + " without multipliers" + times(factor);
      break;
    }
  if (what.empty() || !shown_zero(rest, Effort::full)) return false;
  out.verdict = Verdict::proved;
  out.what = what;
  return true;
}

// True if the solved constraints determine the dependent derivatives at arbitrary points, but not at the start of the
// motion: constraints may depend on each other on the whole manifold.
bool Comparer::singular_at_start() const {
  constexpr double kSingular = 1e-9;
  const Elimination& E = elimination_;
  PointValues* const at = E.point();
  if (!at) return false;
  const Column unknown = E.D(jets(*M_.model, E.m));
  Matrix<double> jacobian(E.phi.size(), unknown.size());
  for (std::size_t r = 0; r < E.phi.size(); ++r) {
    const Column row = gradient(E.phi[r], unknown);
    for (std::size_t j = 0; j < unknown.size(); ++j) jacobian(r, j) = (*at)(row[j]);
  }
  return choose_rows(jacobian, kSingular).independent.size() < E.phi.size();
}

// Returns true if the verdict is decided.
bool Comparer::on_manifold(Expr P, bool regular, Comparison& out) {
  const Elimination& E = elimination_;
  const Graph& g = M_.graph();
  if (!E.solved || E.quasi || E.dependent.empty()) return false;
  for (NodeId id : symbols({&P, 1}))
    if (g.node(id).kind == Kind::multiplier) return false;
  const Expr on = put_rates(*M_.model, E.on(P));
  const int highest = jet_order(on);
  if (highest > static_cast<int>(std::max(2U, E.m))) return false;
  if (shown_zero(on, Effort::full)) {
    out.verdict = Verdict::proved;
    out.of_constraints = true;
    out.what = "a consequence of the constraints alone";
    return true;
  }
  std::vector<PointValues> points;
  for (int k = 0; k < kPoints; ++k) points.push_back(generic_values(k));
  const Column& a = contractions();
  Column by, leading;
  for (unsigned k = 2; k <= std::max(2U, E.m); ++k)
    for (Expr jet : E.I(jets(*M_.model, k))) by.push_back(jet);
  leading = E.I(jets(*M_.model, std::max(2U, E.m)));
  const Column p = gradient(on, by);
  for (std::size_t nu = 0; nu < a.size(); ++nu) {
    const Column f = gradient(a[nu], by);
    for (std::size_t j = 0; j < by.size(); ++j) {
      const double slope = points[0](f[j]);
      if (is_zero(f[j]) || is_zero(p[j]) || !(std::abs(slope) > 1e-9)) continue;
      const Expr factor = tidy(p[j] / f[j]), rest = on - factor * a[nu];
      if (!vanishes(rest, points)) break;
      if (!shown_zero(rest, Effort::full)) return false;
      out.verdict = Verdict::proved;
      out.what = "the equation of " + M_.model->coordinates[E.independent[nu]].name + " without multipliers" +
                 times(factor) + ", with the constraints put in";
      return true;
    }
  }
  if (regular) return false;
  // A point at which all contractions hold belongs to a motion if they determine the highest independent derivatives,
  // and if every constraint is substituted in its own order: a lifted constraint holds at points where the constraint
  // itself does not.
  for (int order : M_.order)
    if (order != static_cast<int>(E.m)) return false;
  if (E.constraints.size() != M_.phi.size()) return false;
  for (Expr e : a)
    if (jet_order(e) > static_cast<int>(std::max(2U, E.m))) return false;
  Matrix<double> jacobian(a.size(), leading.size());
  for (std::size_t nu = 0; nu < a.size(); ++nu) {
    const Column f = gradient(a[nu], leading);
    for (std::size_t j = 0; j < leading.size(); ++j) jacobian(nu, j) = points[0](f[j]);
  }
  Lu<double> lu;
  if (!lu.factor(jacobian)) return false;
  WitnessSearch search = find_witness(Difference{{}, on, {}, {}, {}, {}}, a, leading, *M_.model);
  out.detail = search.detail;
  out.witness = std::move(search.witness);
  if (!out.witness) return false;
  out.verdict = Verdict::refuted;
  return true;
}

}  // namespace anholon
