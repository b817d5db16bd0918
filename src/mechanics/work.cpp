#include "mechanics/work.h"

#include "expr/degree.h"
#include "expr/normal.h"
#include "print/arrange.h"

namespace anholon {

namespace {

constexpr int kHighestDegree = 4;

// Returns the sort key of a formula: whether it contains velocities, and its printed length.
std::pair<bool, std::size_t> burden(Expr e, const SymbolNames& names) {
  return {jet_order(e) > 0, print(e, names, Format::text).size()};
}

}  // namespace

Expr power_factor(const Mechanics& m, std::size_t r) {
  const Model& model = *m.model;
  Graph& g = m.graph();
  const Expr phi = put_masses(model, m.phi[r]);
  if (m.order[r] == 0) {
    // sum Phi q' is the total derivative without its explicit part.
    const Expr rate = by_time(phi);
    return proved_zero(rate) ? g.zero() : arranged(-rate, model.names);
  }
  if (m.order[r] == 1 &&
      homogeneous_degree(m.phi[r], [](const Node& n) { return n.kind == Kind::jet && n.order == 1; }))
    return g.zero();
  Expr radial = g.zero();
  for (std::size_t a = 0; a < m.q.size(); ++a)
    if (!is_zero(m.Phi[r][a])) radial += m.qd[a] * put_masses(model, m.Phi[r][a]);
  if (proved_zero(radial)) return g.zero();
  Expr best = arranged(radial, model.names);
  if (m.order[r] > 1) return best;
  for (int d = 1; d <= kHighestDegree; ++d) {
    const Expr rest = radial - Rational(d) * phi;
    if (proved_zero(rest)) return g.zero();
    const Expr e = arranged(rest, model.names);
    if (burden(e, model.names) < burden(best, model.names)) best = e;
  }
  return best;
}

}  // namespace anholon
