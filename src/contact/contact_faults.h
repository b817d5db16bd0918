// The reasons for which a motion with contacts cannot go on from the state of its bodies, as outcomes that tell the time
// and what to do.
#pragma once
#include "base/outcome.h"
#include "contact/surface/gap_roots.h"
#include "contact/touching_bodies.h"

namespace anholon {

class ContactFaults {
 public:
  // `contacts` and `bodies` outlive this object; the expressions of `contacts` belong to the graph of `s`.
  ContactFaults(Workspace& s, const std::vector<Contact>& contacts, TouchingBodies& bodies)
      : s_(s), bodies_(bodies), roots_(s, contacts) {}

  // Fails if a gap is negative by more than round-off: at the start, during the motion, or beyond a border where its
  // surface jumps.
  Outcome inside_at_start();
  Outcome inside();
  Outcome inside_behind_jump();
  // Fails if a contact has not done what its mode says.
  Outcome not_as_its_mode() const;
  // Fails if the gap or the slip velocity of a touching contact has no derivatives.
  Outcome not_regular() const;
  // Fails if a touching body lies flat; `nearly`: also if it is about to.
  Outcome lies_flat(bool nearly);
  // The outcome if this number of modes of the closed contacts, other than one, is consistent.
  Outcome undecided(std::size_t modes) const;

  // Explains the outcome of a segment in terms of the contacts. The velocities at the start of a mode are not from the
  // user, so it does not blame the user's values.
  void explain(Outcome& outcome) const;
  // If the motion is singular, names the angles that are near their singularity.
  void name_angles(Outcome& outcome) const;

 private:
  double now() const { return bodies_.at.t.get_d(); }
  // The first contact with a negative gap.
  std::optional<std::size_t> below(bool at_start) const;
  Outcome negative_gap(std::size_t contact, const std::string& where, const std::string& hint) const;

  Workspace& s_;
  TouchingBodies& bodies_;
  GapRoots roots_;
};

}  // namespace anholon
