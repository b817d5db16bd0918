// The bodies of a motion with contacts where a mode of the contacts has ended: their state, and their next modes.
#pragma once
#include "contact/law/contact_dynamics.h"
#include "contact/law/impact.h"
#include "contact/law/round_off.h"
#include "contact/surface/borders.h"

namespace anholon {

struct TouchingBodies {
  TouchingBodies(Workspace& s, const std::vector<Contact>& contacts, ContactState at);
  TouchingBodies(const TouchingBodies&) = delete;
  TouchingBodies& operator=(const TouchingBodies&) = delete;

  // The changes of modes that the event at the end of the last segment excludes.
  struct Excluded {
    bool touch = false, stick = false, slips = false;
  };

  // Allows a contact to stick that the last events exclude from it.
  void may_stick_again(std::size_t c) { excluded[c].stick = earlier[c].stick = false; }

  // Evaluates the equations at the state, and notes how fast the bodies might fall from it.
  void look();
  // The equations of the accelerations, in which each contact may do what its gap and the event at the end of the last
  // segment allow, with what earlier events exclude.
  ContactProblem with_touching() const;
  // True if a slip has ended, by itself in the last segment, or because another one has ended and bodies join the two.
  bool slip_has_ended(std::size_t c) const;
  // Stops the remaining velocities of slips with two components that have ended, by the jump of least change: if they
  // begin again, they have new directions.
  void stop_ended_slips();
  // Sets velocities and coordinates to zero that are round-off of their earlier values: if the modes allow no motion,
  // the remainders would contradict each other.
  void come_to_rest();
  // Drops the remainders of velocities that a jump has stopped. Velocities that a constraint joins, as the norm of a
  // quaternion does, are dropped together, because a part of them would contradict the constraint. They are kept if
  // sticking contacts would slip without them.
  void drop_left_over();
  // The slip velocity above which a contact that slips has the direction v/|v|; nullopt if v is small, unless the slip
  // has turned since, so that it does not pass zero.
  std::optional<long double> fast(std::size_t c) const;
  // Passes the borders of surfaces at which the bodies are, and over which their velocities lead; returns true if there
  // is one. Then the formulas of gaps and slip velocities are those of the other side, and their round-off there is
  // removed.
  bool pass_borders();
  // The closed contact whose surface has an edge, with another normal on its other side, at which the bodies have come
  // to rest.
  std::optional<std::size_t> on_edge();
  // True if a slip velocity is more than the remainder of one that has stopped.
  bool slips_fast(std::size_t c) const;
  // True if a closed gap shrinks.
  bool shrinks() const;
  // If no mode is consistent for impacts within round-off of one instant, they follow each other: only the contact with
  // the least gap strikes first.
  void first_alone(std::vector<bool>& touches) const;
  // Applies the jump of least change after which touching contacts do not move along their normals, and sticking ones
  // do not slip. A contact that the others stop already is left out. One with a direction slips along it with friction
  // in proportion to the normal impulse, whichever sign this has: the impulse stands for the impulses still to come,
  // less the load of the rest until then (theory: contact).
  // Returns the impulses of the jump.
  Impulses stop(const ContactModes& to);
  // Moves what touches so that its gaps are zero, with the velocities that the modes allow there.
  void close_gaps();
  void add_to_velocities(const std::vector<long double>& jump);
  // Applies the jump of least change that gives a contact the slip velocity v along d.
  void set_slip(std::size_t c, const std::array<long double, 2>& d, long double v);
  // Bounds `rest` of a slip with two components by half of its initial velocity; a slip that begins below its `rest`
  // would never pass it.
  void bound_rest();
  // Sets the direction of a slip that begins because the friction that holds has become too large: against this
  // friction, which is that of the mode before; resistance to rolling turns it.
  void against_friction(ContactProblem& p, std::size_t c) const;
  // The initial places of a segment close the gaps of what touches, which may push an open gap below the depth at which
  // it hits. Returns true in that case; the depth then becomes that of the gap.
  bool deeper(const std::vector<double>& q);

  // Names a contact that does not do what its mode says: it sticks and moves, or slips against its direction. Such a
  // motion is wrong, whatever the residuals of its equations are.
  std::optional<std::string> contradiction() const;

  // Unmarks remainders of velocities whose terms in a constraint matter beside those of velocities that stay: without
  // them the constraint would not hold.
  void keep_what_constraints_need(std::vector<bool>& left_over) const;
  // The largest slip velocity of a contact that sticks, relative to its terms.
  long double slip_of_what_sticks() const;

  const std::vector<Contact>& contacts;
  ContactDynamics dynamics;
  ContactState at;
  SurfaceBorders borders;
  RoundOff near;
  ContactModes modes;  // of the last segment, or of the next one
  std::vector<Excluded> excluded;
  // What the events before the last segment exclude, if its length is that of round-off: two contacts that stop to
  // press and to stick together would otherwise be chosen in turn.
  std::vector<Excluded> earlier;
  std::vector<bool> turned;             // true if the last segment ended because a slip turned
  long double before = 0;               // the largest acceleration without contacts at the start of the last mode
  std::vector<long double> most_place;  // the largest value of each coordinate at a change of mode
};

}  // namespace anholon
