#include "contact/law/impact_states.h"

namespace anholon {

ImpactStates::ImpactStates(Workspace& s, const std::vector<Contact>& contacts) : graph_(s.graph()) {
  if (contacts.empty() || !contacts[0].forces) return;
  Graph& g = s.graph();
  Column outputs;
  for (const ContactForces::Formula& f : contacts[0].forces->formulas) {
    if (f.of != ContactForces::Formula::Of::rate) continue;
    const Expr rate = g.own(f.value);
    Column forces;
    for (const NodeId id : symbols({&rate, 1}))
      if (const Node n = g.node(id); n.kind == Kind::multiplier && n.index >= kContactForces) {
        forces.push_back({&g, id});
        slopes_.push_back({f.index, contacts[0].forces->forces[n.index - kContactForces]});
      }
    for (const Expr slope : put_masses(*s.model, gradient(rate, forces))) outputs.push_back(slope);
  }
  if (outputs.empty()) return;
  tape_ = compile(outputs);
  machine_.emplace(*tape_, 0, parameter_values<long double>(*s.model));
}

void ImpactStates::add(ContactState& at, const std::vector<long double>& after, const Impulses& impulses) {
  if (!machine_) return;
  ContactState mean = at;
  for (std::size_t a = 0; a < after.size(); ++a) mean.qd[a] = static_cast<double>((at.qd[a] + after[a]) / 2);
  evaluate_at(mean, graph_, *machine_);
  std::vector<long double> jumps(at.states.size(), 0);
  for (std::size_t k = 0; k < slopes_.size(); ++k) {
    const auto& [contact, friction] = slopes_[k].force;
    jumps[slopes_[k].state] +=
        machine_->value(k) * (friction ? impulses.tangential[contact][*friction] : impulses.normal[contact]);
  }
  for (std::size_t z = 0; z < jumps.size(); ++z) at.states[z] = static_cast<double>(at.states[z] + jumps[z]);
}

}  // namespace anholon
