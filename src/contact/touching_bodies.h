// The bodies of a motion with contacts where a mode of the contacts has ended: their state, and what they may do next.
#pragma once
#include "contact/law/contact_dynamics.h"
#include "contact/law/round_off.h"
#include "contact/surface/borders.h"

namespace anholon {

struct TouchingBodies {
  TouchingBodies(Workspace& s, const std::vector<Contact>& contacts, ContactState at);
  TouchingBodies(const TouchingBodies&) = delete;
  TouchingBodies& operator=(const TouchingBodies&) = delete;

  // What the event at which the last segment ended excludes.
  struct Excluded {
    bool touch = false, stick = false, slips = false;
  };

  // Evaluates the equations at the state, and notes how fast the bodies might fall from it.
  void look();
  // The accelerations, in which each contact may do what its gap and the event at which the last segment ended allow.
  ContactProblem with_touching() const;
  // Whether a slip has ended, with the last segment or as bodies join it with one that has.
  bool slip_has_ended(std::size_t c) const;
  // Stops what slips with two components that have ended leave of their velocities, by the jump of least change: if they begin
  // again, their directions are new ones.
  void stop_ended_slips();
  // Velocities within round-off of those that the motion had are zero, and so are coordinates: where the modes leave no
  // motion, the remainders would contradict each other.
  void come_to_rest();
  // What the jump leaves of velocities that it stops. Those that a constraint joins, as the norm of a quaternion does, are
  // dropped together: a part of them would contradict the constraint. They stay where without them what sticks would slip.
  void drop_left_over();
  // From which slip velocity on a contact that slips has the direction v/|v|: nullopt where v is small, unless it has turned
  // since, so that it passes no zero.
  std::optional<long double> fast(std::size_t c) const;
  // Passes the borders of surfaces at which the bodies are, and that their velocities lead them over; returns whether there is one.
  // The formulas of gaps and slip velocities are then those of the other side, and what is round-off there is removed.
  bool pass_borders();
  // The closed contact whose surface has an edge, with another normal on its other side, at which the bodies have come to rest.
  std::optional<std::size_t> on_edge();
  // Whether a slip velocity is more than what is left of one that has stopped.
  bool slips_fast(std::size_t c) const;
  // Whether a closed gap shrinks.
  bool shrinks() const;
  // Impacts within round-off of one instant for which no mode is consistent follow each other: the least gap comes first.
  void first_alone(std::vector<bool>& touches) const;
  // The jump of least change after which what touches does not move along its normal, and what sticks does not slip. A
  // contact that the others stop already is left out. One with a direction slips along it with friction in proportion to the
  // normal impulse, whichever sign this has: it stands for the impulses still to come, less the load of the rest until then
  // (theory: contact).
  void stop(const ContactModes& to);
  // Moves what touches so that its gaps are zero, with the velocities that the modes leave there.
  void close_gaps();
  void add_to_velocities(const std::vector<long double>& jump);
  // The jump of least change that gives a contact the slip velocity v along d.
  void set_slip(std::size_t c, const std::array<long double, 2>& d, long double v);
  // A slip with two components that begins below its `rest` ends below half of what it begins with: it would never pass the other.
  void bound_rest();
  // A slip that begins where the friction that holds has become too large begins against this friction, which is that of
  // the mode before: resistance to rolling turns it.
  void against_friction(ContactProblem& p, std::size_t c) const;
  // The places at which a segment begins close the gaps of what touches, which may push an open gap below the depth at which
  // it hits. Returns whether that is so; the depth is then that of the gap.
  bool deeper(const std::vector<double>& q);

  // The contact that does not do what its mode says, and how: it sticks and moves, or slips against its direction. Such a motion
  // is none, whatever the residuals of its equations.
  std::optional<std::string> contradiction() const;

  // Takes back velocities that are left over, but of which a constraint has terms among those of velocities that stay: without
  // them it would not hold.
  void keep_what_constraints_need(std::vector<bool>& left_over) const;
  // The largest slip velocity of a contact that sticks, as a part of its terms.
  long double slip_of_what_sticks() const;

  const std::vector<Contact>& contacts;
  ContactDynamics dynamics;
  ContactState at;
  SurfaceBorders borders;
  RoundOff near;
  ContactModes modes;  // of the last segment, or of the next one
  std::vector<Excluded> excluded;
  std::vector<bool> turned;             // whether the last segment ended as a slip turned
  long double before = 0;               // the largest acceleration without contacts where the last mode began
  std::vector<long double> most_place;  // the largest value of each coordinate at a change of mode
};

}  // namespace anholon
