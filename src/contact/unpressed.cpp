#include "contact/unpressed.h"

#include <algorithm>
#include <cmath>

#include "contact/law/consistent_modes.h"
#include "contact/law/shared_forces.h"

namespace anholon {

namespace {

// Forces below this part of the largest one are round-off.
constexpr long double kNothing = 1e-12L;

// Leaves out the constraints that may keep a gap at this place or time alone: their rows change, or their rates depend
// on more than the velocities, as those of a drive do.
ContactProblem with_lasting_rows(ContactProblem p, const Workspace& s) {
  const Graph& g = s.mechanics->graph();
  // True if a formula contains no more than parameters, and coordinates or their derivatives of this order.
  const auto only = [&](Expr e, std::optional<int> order) {
    const std::vector<NodeId> ids = symbols({&e, 1});
    return std::all_of(ids.begin(), ids.end(), [&](NodeId id) {
      const Node& n = g.node(id);
      return n.kind == Kind::parameter || (n.kind == Kind::jet && n.order == order);
    });
  };
  std::vector<std::vector<long double>> lasting;
  for (std::size_t r = 0; r < p.Phi.size(); ++r) {
    const std::size_t of = s.independent[r];
    const Column& row = s.mechanics->Phi[of];
    const auto constant = [&](Expr e) { return only(e, std::nullopt); };
    if (std::all_of(row.begin(), row.end(), constant) && only(s.mechanics->phi[of], s.mechanics->order[of]))
      lasting.push_back(p.Phi[r]);
  }
  p.Phi = std::move(lasting);
  return p;
}

// True if others keep the gap of a closed contact, and would not without the constraints whose rows change.
bool kept_here_alone(const Workspace& s, const ContactProblem& p, ContactModes modes, std::size_t contact) {
  modes[contact].touch = Touch::open;
  return others_keep_gap(p, modes, contact) && !others_keep_gap(with_lasting_rows(p, s), modes, contact);
}

}  // namespace

void note_rests(TouchingBodies& bodies, const ContactProblem& p, const ContactSolution& now) {
  const long double least = kNothing * size_of_forces(p, now);
  const auto free = of_modes(p, ContactModes(bodies.contacts.size()));
  for (std::size_t c = 0; c < bodies.contacts.size(); ++c) {
    const bool moves = p.contacts[c].moves || bodies.excluded[c].stick ||
                       (free && bodies.dynamics.slip_acceleration(c, now.x) >
                                    kNothing * bodies.dynamics.slip_acceleration(c, free->x));
    bodies.modes[c].rests =
        free && bodies.contacts[c].rough() && bodies.modes[c].touch == Touch::slips && now.normal[c] <= least && !moves;
  }
}

void note_still(TouchingBodies& bodies, const Workspace& s, const ContactProblem& p) {
  for (std::size_t c = 0; c < bodies.contacts.size(); ++c) {
    const std::vector<long double>& n = p.contacts[c].normal;
    bool rests = bodies.modes[c].touch == Touch::open && bodies.near.closed(c) && !bodies.contacts[c].under;
    for (std::size_t a = 0; rests && a < n.size(); ++a) rests = n[a] == 0 || bodies.at.qd[a] == 0;
    bodies.modes[c].still = rests && others_keep_gap(with_lasting_rows(p, s), bodies.modes, c);
  }
}

void leave_open(const TouchingBodies& bodies, const Workspace& s, ContactProblem& p,
                std::vector<ContactSolution>& list) {
  const long double least = kNothing * size_of_forces(p, list[0]);
  ContactProblem open = p;
  bool any = false;
  for (std::size_t c = 0; c < bodies.contacts.size(); ++c) {
    if (list[0].modes[c].touch == Touch::open || p.contacts[c].under || list[0].normal[c] > least) continue;
    const bool was_open =
        c < bodies.modes.size() && bodies.modes[c].touch == Touch::open && !bodies.near.has_reached(c);
    if (!was_open && !kept_here_alone(s, p, list[0].modes, c)) continue;
    open.contacts[c].may_touch = false, any = true;
  }
  if (!any) return;
  std::vector<ContactSolution> found = consistent_modes(open);
  if (found.size() == 1) p = std::move(open), list = std::move(found);
}

}  // namespace anholon
