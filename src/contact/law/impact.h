// The jumps of the velocities at an impact (theory: contact).
//
// Newton: the velocity of the gap is reversed and multiplied by the restitution e. Poisson: an impact is a compression,
// whose impulse N_c stops the gap, and an expansion with the impulse e N_c, or more where the gap would close; friction
// obeys Coulomb's law in both. The work of the impulses p of the contacts is p (u- + u+)/2, in which u- and u+ are the velocities
// relative to the surfaces, before and after: it is the same for all observers, and an impact that takes energy away has W <= 0.
#pragma once
#include "contact/law/contact_dynamics.h"

namespace anholon {

// The outcome where no mode of the contacts, or several, are consistent. contacts: "'floor' "; when: " at t = 1".
Outcome painleve(std::size_t modes, const std::string& contacts, const std::string& when);

// The outcome where a contact alone loses rank (ContactDynamics::loses_rank), so that nothing is known of its modes.
Outcome rank_lost(const Contact& contact, const std::string& when);

// The outcome where the gap of a closed contact has no derivatives (ContactDynamics::has_derivatives), or its slip velocity has no
// value or no derivatives (ContactDynamics::has_slip).
Outcome without_derivatives(const Contact& contact, const std::string& when);
Outcome without_slip(const Contact& contact, const std::string& when);
// The outcome where the gap of a closed contact loses its derivatives, as a root in it has fallen to this part of what it was.
Outcome lies_flat(const Contact& contact, long double part, const std::string& when);

// The outcome where a body comes to rest at an edge of the surface of a contact, or strikes its sides without end.
Outcome on_edge(const Contact& contact, const std::string& when);
// The outcome where a body comes upon an edge of the surface of a contact, and moves to none of its sides.
Outcome meets_edge(const Contact& contact, const std::string& when);

// The impulses of the contacts: along their gaps, and along the components of their slip velocities.
struct Impulses {
  explicit Impulses(std::size_t contacts) : normal(contacts), tangential(contacts) {}
  std::vector<long double> normal;
  std::vector<std::array<long double, 2>> tangential;
};
struct Impact {
  std::vector<long double> jump;  // of the velocities
  Impulses impulses{0};
  long double work = 0;   // of the impulses of the contacts, by relative velocities
  long double terms = 0;  // the size of the terms of this work
};

// The consistent impacts, of which there is one unless bodies jam (Painlevé's paradox). touches: the contacts that take part;
// all contacts that strike have one law.
std::vector<Impact> impacts(const ContactDynamics& dynamics, const std::vector<Contact>& contacts,
                            const std::vector<bool>& touches);

}  // namespace anholon
