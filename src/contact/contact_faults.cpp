#include "contact/contact_faults.h"

#include "contact/law/impact.h"
#include "contact/law/shared_forces.h"
#include "numeric/told_time.h"
#include "observe/angles.h"

namespace anholon {

std::optional<std::size_t> ContactFaults::below(bool at_start) const {
  bodies_.dynamics.go(bodies_.at);
  for (std::size_t c = 0; c < bodies_.contacts.size(); ++c)
    if (bodies_.dynamics.place(c).gap < 0 &&
        !(at_start ? bodies_.near.negligible_at_start(c) : bodies_.near.negligible(c)))
      return c;
  return std::nullopt;
}

Outcome ContactFaults::negative_gap(std::size_t contact, const std::string& where, const std::string& hint) const {
  const Contact& c = bodies_.contacts[contact];
  return told({OutcomeKind::inconsistent,
               "the gap of contact '" + c.name + "' is " +
                   number_text(static_cast<double>(bodies_.dynamics.place(contact).gap), 6) +
                   (c.units.gap.empty() ? "" : " " + c.units.gap) + where + ", and a gap is not negative",
               hint, c.span},
              now());
}

Outcome ContactFaults::inside_at_start() {
  const auto c = below(true);
  if (!c) return {};
  const char* const remedy =
      bodies_.contacts[*c].shape.empty()
          ? "change the sign of the gap: it is positive while the contact is open"
          : "tell where the plane, ball or bowl is by 'through', and by 'normal' on which side of a plane the body is";
  return negative_gap(*c, " at the start",
                      std::string("start where the gap is zero or positive, by [initial] or --q, or ") + remedy);
}

Outcome ContactFaults::inside() {
  const auto c = below(false);
  if (!c) return {};
  return negative_gap(
      *c, at_time(now()),
      "the contact is deeper than the round-off of its event: take a smaller --tolerance, or end the motion before");
}

Outcome ContactFaults::inside_behind_jump() {
  const auto c = below(false);
  if (!c) return {};
  return negative_gap(*c, at_time(now()) + " where its surface jumps",
                      "a jump of a surface has no velocity with which it strikes: let the surface move there within a "
                      "short time, or write a contact for each of its parts");
}

Outcome ContactFaults::not_as_its_mode() const {
  const auto how = bodies_.contradiction();
  if (!how) return {};
  return told(
      {OutcomeKind::inconsistent, *how + at_time(now()), "please report the model, as this is a bug of anholon"},
      now());
}

Outcome ContactFaults::not_regular() const {
  for (std::size_t c = 0; c < bodies_.contacts.size(); ++c) {
    if (!bodies_.near.closed(c) && bodies_.dynamics.place(c).gap > 0) continue;
    if (!bodies_.dynamics.has_derivatives(c)) return without_derivatives(bodies_.contacts[c], now());
    if (!bodies_.dynamics.has_slip(c)) return without_slip(bodies_.contacts[c], now());
  }
  return {};
}

Outcome ContactFaults::lies_flat(bool nearly) {
  // The part to which the sine of the tilt of a disc has fallen.
  constexpr long double kFlat = 1e-5L, kNearlyFlat = 1e-4L;
  roots_.see(bodies_.at);
  for (std::size_t c = 0; c < bodies_.contacts.size(); ++c)
    if (const long double part = roots_.least_part(c); bodies_.near.closed(c) && part < (nearly ? kNearlyFlat : kFlat))
      return anholon::lies_flat(bodies_.contacts[c], part, now());
  return {};
}

Outcome ContactFaults::undecided(std::size_t modes) const {
  const ContactProblem p = bodies_.with_touching();
  std::string names;
  for (std::size_t c = 0; c < bodies_.contacts.size(); ++c) {
    if (!bodies_.near.closed(c) || bodies_.contacts[c].under) continue;
    names += (names.empty() ? "'" : ", '") + bodies_.contacts[c].name + "'";
    if (modes > 0) continue;
    if (others_keep_gap(p, ContactModes(bodies_.contacts.size()), c)) return led_into(bodies_.contacts[c], now());
    if (bodies_.dynamics.loses_rank(c)) return rank_lost(bodies_.contacts[c], now());
  }
  return painleve(modes, names + " ", now());
}

// If the event of a contact has no value, its gap has none.
static void name_gap(const Contact& c, Outcome& outcome) {
  const std::string event = "the formula of the event '" + c.name + ".hits' has no value";
  if (outcome.kind != OutcomeKind::not_a_number || !outcome.message.starts_with(event)) return;
  outcome.message.replace(0, event.size(), "the gap of contact '" + c.name + "' has no value");
  outcome.hint = "a gap has values on both sides of the surface: abs(z)^n*sign(z) in place of z^n";
  outcome.place = c.span;
}

void ContactFaults::explain(Outcome& outcome) const {
  if (outcome.kind == OutcomeKind::inconsistent)
    outcome = told({OutcomeKind::singular, "no velocities fit the modes of the contacts" + at_time(now()),
                    "end the motion before, or take coordinates that are regular there"},
                   now());
  for (const Contact& c : bodies_.contacts) name_gap(c, outcome);
  name_angles(outcome);
}

void ContactFaults::name_angles(Outcome& outcome) const {
  constexpr double kNear = 0.1;
  if (outcome.kind != OutcomeKind::singular) return;
  AngleWatch watch(s_, parameter_values<double>(*s_.model));
  watch.see(now(), [this](std::size_t a) { return bodies_.at.q[a]; });
  for (std::size_t i = 0; i < watch.triples.size(); ++i) {
    if (!(watch.least[i].value < kNear)) continue;
    const AngleTriple& triple = watch.triples[i];
    outcome.message += "; the angles " + triple.angles + " of '" + triple.body + "' are near their singularity";
    outcome.hint = "end the motion before, or describe the orientation of '" + triple.body +
                   "' by a quaternion: quat(e0, e1, e2, e3)";
  }
}

}  // namespace anholon
