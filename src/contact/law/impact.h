// The jumps of the velocities at an impact (theory: contact).
//
// Newton: the velocity of the gap is reversed and multiplied by the restitution e. Poisson: an impact is a compression,
// whose impulse N_c stops the gap, and an expansion with the impulse e N_c, or more if the gap would close; friction
// obeys Coulomb's law in both. The work of the impulses p of the contacts is p (u- + u+)/2, where u- and u+ are the
// velocities relative to the surfaces, before and after: it is the same for all observers, and an impact that takes
// energy away has W <= 0.
#pragma once
#include "contact/law/contact_dynamics.h"

namespace anholon {

// The outcome if no mode of the contacts, or more than one, is consistent. `contacts`: "'floor' ". The messages of these outcomes
// tell the time t.
Outcome painleve(std::size_t modes, const std::string& contacts, double t);

// The outcome if a contact alone loses rank (ContactDynamics::loses_rank), so that its modes cannot be judged.
Outcome rank_lost(const Contact& contact, double t);
// The outcome if the constraints decide how the gap of a closed contact changes, and close it further.
Outcome led_into(const Contact& contact, double t);

// The outcomes if the gap of a closed contact has no derivatives (ContactDynamics::has_derivatives), and if its slip
// velocity has no value or no derivatives (ContactDynamics::has_slip).
Outcome without_derivatives(const Contact& contact, double t);
Outcome without_slip(const Contact& contact, double t);
// The outcome if the gap of a closed contact loses its derivatives, because a root in it has fallen to this part of its
// largest value.
Outcome lies_flat(const Contact& contact, long double part, double t);

// The outcome if a body comes to rest at an edge of the surface of a contact, or strikes its sides without end.
Outcome on_edge(const Contact& contact, double t);
// The outcome if a body arrives at an edge of the surface of a contact, and moves to none of its sides.
Outcome meets_edge(const Contact& contact, double t);

// The impulses of the contacts: along their gaps, and along the components of their slip velocities.
struct Impulses {
  explicit Impulses(std::size_t contacts) : normal(contacts), tangential(contacts) {}
  std::vector<long double> normal;
  std::vector<std::array<long double, 2>> tangential;
};
// Adds the impulses of a solution. Contacts of the problem beyond those of `sum` are the friction of the contacts that
// they are under.
void add_impulses(const ContactProblem& problem, const ContactSolution& solution, Impulses& sum);

struct Impact {
  std::vector<long double> jump;  // the jump of the velocities
  Impulses impulses{0};
  long double work = 0;   // of the impulses of the contacts, by relative velocities
  long double terms = 0;  // the size of the terms of this work
};

// Returns the consistent impacts; there is one unless bodies jam (Painlevé's paradox). `touches`: the contacts that
// take part. All contacts that strike have one law.
std::vector<Impact> impacts(const ContactDynamics& dynamics, const std::vector<Contact>& contacts,
                            const std::vector<bool>& touches);

}  // namespace anholon
