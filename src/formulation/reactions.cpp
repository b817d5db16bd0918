#include "formulation/reactions.h"

namespace anholon {

ReactionFormulas reaction_formulas(const Mechanics& M, const Formulation& form, const Elimination& E) {
  Graph& g = M.graph();
  const auto here = [&](const Column& X) { return form.eliminates() ? E.on(X) : X; };
  // A constraint that an input keeps has no multiplier here, because the input itself acts.
  const auto kept_by_inputs = [&](NodeId id) {
    const Node& n = g.node(id);
    if (n.kind != Kind::multiplier || !M.model->constraints[n.index].by) return Expr{};
    return g.control(static_cast<std::uint32_t>(*M.model->constraints[n.index].by), n.order);
  };
  ReactionFormulas out;
  out.by_multipliers = here(M.N);
  const Column inertia = lagrange_operator(M), G = forces(M), a = here(inertia - G);
  for (std::size_t s = 0; s < a.size(); ++s) out.by_motion.push_back(is_zero(M.N[s]) ? g.zero() : a[s]);
  const Column a_D = E.D(a);
  for (const Constraint& c : M.model->constraints) out.multipliers.push_back(c.by ? Expr{} : g.zero());
  for (std::size_t k = 0; k < E.constraints.size(); ++k) {
    std::vector<Expr> terms;
    for (std::size_t b = 0; b < a_D.size(); ++b) {
      const Expr entry = here({E.Phi_D_inverse[b][k]})[0];
      if (!is_zero(entry)) terms.push_back(entry * a_D[b]);
    }
    out.multipliers[E.constraints[k]] = terms.empty() ? g.zero() : sum(terms);
  }
  for (const Load& load : reactions(*M.model)) {
    const Column r = here(substitute(
        Column{load.force.x, load.force.y, load.force.z, load.torque.x, load.torque.y, load.torque.z}, kept_by_inputs));
    out.loads.push_back({{r[0], r[1], r[2]}, {r[3], r[4], r[5]}});
  }
  return out;
}

}  // namespace anholon
