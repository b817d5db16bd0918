#include "contact/law/impact.h"

#include <algorithm>

#include "contact/law/consistent_modes.h"
#include "numeric/number.h"

namespace anholon {

namespace {

using Jump = std::vector<long double>;

// The impulses of a solution; those of friction that stands under a contact of its own at the end of the list are added to it.
Impulses impulses(const ContactProblem& p, const ContactSolution& f, std::size_t count) {
  Impulses all;
  all.normal.resize(count), all.friction.resize(count);
  for (std::size_t c = 0; c < p.contacts.size(); ++c) {
    const ContactRows& rows = p.contacts[c];
    const ContactMode& mode = f.modes[c];
    const std::size_t of = c < count ? c : *rows.under;
    if (!rows.under) all.normal[of] += f.normal[c];
    for (std::size_t k = 0; mode.touch != Touch::open && k < rows.tangential.size(); ++k)
      all.friction[of][k] +=
          mode.touch == Touch::sticks ? f.friction[c][k] : -rows.friction * f.normal[c] * mode.direction[k];
  }
  return all;
}

std::vector<ImpactJump> jumps(const ContactProblem& p, const std::vector<ContactSolution>& solutions,
                              std::size_t count) {
  std::vector<ImpactJump> list;
  for (const ContactSolution& s : solutions) list.push_back({s.x, impulses(p, s, count)});
  return list;
}

void add_rates(long double& rate, const std::vector<long double>& row, const Jump& x) {
  for (std::size_t a = 0; a < x.size(); ++a) rate += row[a] * x[a];
}

// The expansion after a compression: the impulses e N_c are given, so each contact is its normal part, and its friction is
// one that this impulse presses as well.
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

}  // namespace

Outcome painleve(std::size_t modes, const std::string& contacts, const std::string& when) {
  if (modes == 0)
    return {OutcomeKind::inconsistent,
            "no mode of the contacts " + contacts + "is consistent (Painlevé's paradox)" + when,
            "rigid bodies with this friction have no motion here: take less friction, or end the motion before"};
  return {OutcomeKind::inconsistent,
          std::to_string(modes) + " modes of the contacts " + contacts + "are consistent (Painlevé's paradox)" + when,
          "rigid bodies with this friction have several motions here: take less friction, or end the motion before"};
}

Outcome rank_lost(const std::string& contact, const std::string& when) {
  return {OutcomeKind::singular,
          "the gap and the slip velocities of contact '" + contact +
              "' are no longer independent in these coordinates" + when,
          "end the motion before, or take coordinates that are regular there: Euler's angles are not where a disc lies "
          "flat"};
}

static constexpr const char* kFlat = "end the motion before, or start a little beside: a disc that lies flat touches "
                                     "with its whole rim, and no point of it is "
                                     "the one that is pushed";

Outcome without_derivatives(const std::string& contact, const std::string& when) {
  return {OutcomeKind::singular, "the gap of contact '" + contact + "' has no derivatives" + when, kFlat};
}

Outcome lies_flat(const std::string& contact, long double part, const std::string& when) {
  return {OutcomeKind::singular,
          "the gap of contact '" + contact + "' loses its derivatives" + when +
              ", as where a disc lies flat: a root in it "
              "has fallen to " +
              number_text(static_cast<double>(part), 2) + " of what it was",
          kFlat};
}

Outcome without_slip(const std::string& contact, const std::string& when) {
  return {OutcomeKind::singular, "the slip velocity of contact '" + contact + "' has no value or no derivatives" + when,
          "start or stop the motion elsewhere, or change the formula so that it is smooth here"};
}

Outcome on_edge(const std::string& contact, const std::string& when) {
  return {OutcomeKind::inconsistent,
          "a body is held by an edge of the surface of contact '" + contact + "'" + when +
              ", where the gap has no derivatives",
          "write a contact for each side of the edge in place of one gap with min, max, abs or piecewise"};
}

std::vector<ImpactJump> impact_jumps(const ContactDynamics& dynamics, const std::vector<Contact>& contacts,
                                     const std::vector<bool>& touches) {
  const std::size_t count = contacts.size();
  const bool poisson =
      std::any_of(contacts.begin(), contacts.end(), [](const Contact& c) { return c.law == ImpactLaw::poisson; });
  ContactProblem p = poisson ? dynamics.impact(touches, 0) : dynamics.impact(touches);
  const std::vector<ContactSolution> first = consistent_modes(p);
  if (!poisson || first.size() != 1) return jumps(p, first, count);
  const Impulses compression = impulses(p, first[0], count);
  p = expansion(dynamics, std::move(p), first[0]);
  std::vector<ImpactJump> list = jumps(p, consistent_modes(p), count);
  for (ImpactJump& jump : list) {
    for (std::size_t a = 0; a < jump.velocities.size(); ++a) jump.velocities[a] += first[0].x[a];
    for (std::size_t c = 0; c < count; ++c) {
      // The impulse e N_c is given, and stands with the forces.
      const long double expanding = dynamics.place(c).restitution * std::max(first[0].normal[c], 0.0L);
      jump.impulses.normal[c] += compression.normal[c] + (contacts[c].under ? 0 : expanding);
      for (std::size_t k = 0; k < 2; ++k) jump.impulses.friction[c][k] += compression.friction[c][k];
    }
  }
  return list;
}

}  // namespace anholon
