#include "contact/law/impact.h"

#include <algorithm>
#include <cmath>

#include "contact/law/consistent_modes.h"
#include "numeric/told_time.h"

namespace anholon {

void add_impulses(const ContactProblem& p, const ContactSolution& of, Impulses& sum) {
  for (std::size_t k = 0; k < p.contacts.size(); ++k) {
    const ContactRows& rows = p.contacts[k];
    const ContactMode& mode = of.modes[k];
    const std::size_t c = k < sum.normal.size() ? k : *rows.under;
    if (!rows.under) sum.normal[c] += of.normal[k];
    for (std::size_t a = 0; a < rows.tangential.size() && mode.touch != Touch::open; ++a)
      sum.tangential[c][a] +=
          mode.touch == Touch::sticks ? of.friction[k][a] : -rows.friction * mode.direction[a] * of.normal[k];
  }
}

namespace {

using Jump = std::vector<long double>;

void add_rates(long double& rate, const std::vector<long double>& row, const Jump& x) {
  for (std::size_t a = 0; a < x.size(); ++a) rate += row[a] * x[a];
}

// The equations of the expansion after a compression. The impulses e N_c are given, so each contact is split: its
// normal part, and its friction, which the given impulse presses as well.
ContactProblem expansion(const ContactDynamics& dynamics, ContactProblem p, const ContactSolution& compression) {
  const std::size_t count = p.contacts.size();
  std::vector<ContactRows> friction;
  for (std::size_t c = 0; c < count; ++c) {
    ContactRows& rows = p.contacts[c];
    const std::size_t normal = rows.under.value_or(c);
    const ContactMode& mode = compression.modes[c];
    rows.pressed = dynamics.place(normal).restitution * std::max(compression.normal[normal], 0.0L);
    for (std::size_t k = 0; k < rows.tangential.size(); ++k) {
      add_rates(rows.tangential_rate[k], rows.tangential[k], compression.x);
      if (mode.touch == Touch::sticks) rows.tangential_rate[k] = 0;
    }
    rows.direction = mode.touch == Touch::slips ? mode.direction : rows.direction;
    if (rows.under) continue;
    add_rates(rows.normal_rate, rows.normal, compression.x);
    if (mode.touch != Touch::open) rows.normal_rate = 0;
    for (std::size_t a = 0; a < p.b.size(); ++a) p.b[a] -= rows.normal[a] * rows.pressed;
    if (rows.rough) friction.push_back(rows), friction.back().under = c;
    rows.rough = false;
    rows.tangential.clear();
    rows.pressed = 0;
  }
  p.contacts.insert(p.contacts.end(), friction.begin(), friction.end());
  return p;
}

Impact with_work(const ContactDynamics& dynamics, Jump jump, Impulses impulses) {
  Impact impact;
  const auto add = [&](long double impulse, long double before, const std::vector<long double>& row) {
    long double change = 0, size = std::abs(before);
    for (std::size_t a = 0; a < jump.size(); ++a) {
      change += row[a] * jump[a];
      size += std::abs(row[a]) * dynamics.most(a);
    }
    impact.work += impulse * (before + change / 2);
    impact.terms += std::abs(impulse) * size;
  };
  const std::vector<ContactRows>& contacts = dynamics.accelerations().contacts;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (impulses.normal[c] != 0) add(impulses.normal[c], dynamics.place(c).gap_rate, contacts[c].normal);
    for (std::size_t a = 0; a < contacts[c].tangential.size(); ++a)
      if (impulses.tangential[c][a] != 0)
        add(impulses.tangential[c][a], dynamics.place(c).slip[a], contacts[c].tangential[a]);
  }
  impact.jump = std::move(jump);
  impact.impulses = std::move(impulses);
  return impact;
}

}  // namespace

Outcome painleve(std::size_t modes, const std::string& contacts, double t) {
  if (modes == 0)
    return told({OutcomeKind::inconsistent,
                 "no mode of the contacts " + contacts + "is consistent (Painlevé's paradox)" + at_time(t),
                 "rigid bodies with this friction have no motion here: take less friction, or end the motion before"},
                t);
  return told(
      {OutcomeKind::inconsistent,
       std::to_string(modes) + " modes of the contacts " + contacts + "are consistent (Painlevé's paradox)" +
           at_time(t),
       "rigid bodies with this friction have several motions here: take less friction, or end the motion before"},
      t);
}

Outcome rank_lost(const Contact& contact, double t) {
  return told(
      {OutcomeKind::singular,
       "the gap and the slip velocities of contact '" + contact.name +
           "' are no longer independent in these coordinates" + at_time(t),
       "end the motion before, or take coordinates that are regular there: Euler's angles are not where a disc lies "
       "flat",
       contact.span},
      t);
}

Outcome led_into(const Contact& contact, double t) {
  return told({OutcomeKind::inconsistent,
               "the constraints lead the bodies through the surface of contact '" + contact.name + "'" + at_time(t) +
                   ", and no force of the contact changes this",
               "start or end the motion elsewhere, or change the constraints: they decide alone how the gap changes",
               contact.span},
              t);
}

// The hint for a contact whose gap has no derivatives.
static std::string beside_or_round(const Contact& contact) {
  if (contact.shape == "disc" || contact.shape == "torus")
    return "end the motion before, or start a little beside: a " + contact.shape +
           " that lies flat touches with a whole circle, and no point of it is the one that is pushed";
  if (!contact.shape.empty()) return "end the motion before, or start a little beside";
  return "start a little beside, or round the apex or the edge by a small length e: sqrt(x^2 + y^2 + e^2) in place of "
         "norm([x, y, 0]) and sqrt(x^2 + e^2) in place of abs(x); the rim of a disc that lies flat is no such edge: "
         "end the motion before";
}

Outcome without_derivatives(const Contact& contact, double t) {
  const bool formula = contact.shape.empty();
  return told(
      {OutcomeKind::singular,
       "the gap of contact '" + contact.name + "' has no derivatives" + at_time(t) +
           (formula ? ", as at the apex of a cone or on an edge, where the normal of a surface has no direction" : ""),
       beside_or_round(contact), contact.span},
      t);
}

Outcome lies_flat(const Contact& contact, long double part, double t) {
  const bool formula = contact.shape.empty();
  return told({OutcomeKind::singular,
               "the gap of contact '" + contact.name + "' loses its derivatives" + at_time(t) +
                   (formula ? ", as at the apex of a cone or where a disc lies flat" : ", as where a disc lies flat") +
                   ": a root in it has fallen to " + number_text(static_cast<double>(part), 2) + " of what it was",
               beside_or_round(contact), contact.span},
              t);
}

Outcome without_slip(const Contact& contact, double t) {
  return told({OutcomeKind::singular,
               "the slip velocity of contact '" + contact.name + "' has no value or no derivatives" + at_time(t),
               "start or stop the motion elsewhere, or change the formula so that it is smooth here", contact.span},
              t);
}

Outcome on_edge(const Contact& contact, double t) {
  return told({OutcomeKind::inconsistent,
               "a body is held by an edge of the surface of contact '" + contact.name + "'" + at_time(t) +
                   ", where the gap has no derivatives",
               "write a contact for each side of the edge in place of one gap with min, max, abs or piecewise",
               contact.span},
              t);
}

Outcome meets_edge(const Contact& contact, double t) {
  return told({OutcomeKind::inconsistent,
               "a body meets an edge of the surface of contact '" + contact.name + "'" + at_time(t) +
                   ", where the normal of the surface has no direction, and moves to none of its sides",
               beside_or_round(contact), contact.span},
              t);
}

std::vector<Impact> impacts(const ContactDynamics& dynamics, const std::vector<Contact>& contacts,
                            const std::vector<bool>& touches) {
  const bool poisson =
      std::any_of(contacts.begin(), contacts.end(), [](const Contact& c) { return c.law == ImpactLaw::poisson; });
  ContactProblem p = poisson ? dynamics.impact(touches, 0) : dynamics.impact(touches);
  std::vector<ContactSolution> found = consistent_modes(p);
  Impulses given(contacts.size());
  Jump compressed(p.b.size(), 0);
  if (poisson && found.size() == 1) {
    const ContactSolution compression = std::move(found[0]);
    add_impulses(p, compression, given);
    for (std::size_t c = 0; c < contacts.size(); ++c)
      if (!p.contacts[c].under)
        given.normal[c] += dynamics.place(c).restitution * std::max(compression.normal[c], 0.0L);
    p = expansion(dynamics, std::move(p), compression);
    found = consistent_modes(p);
    compressed = compression.x;
  }
  std::vector<Impact> list;
  for (const ContactSolution& s : found) {
    Impulses sum = given;
    add_impulses(p, s, sum);
    Jump jump = s.x;
    for (std::size_t a = 0; a < jump.size(); ++a) jump[a] += compressed[a];
    list.push_back(with_work(dynamics, std::move(jump), std::move(sum)));
  }
  return list;
}

}  // namespace anholon
